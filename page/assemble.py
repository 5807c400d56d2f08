#!/usr/bin/env python3
"""Makes one HTML file of the page, with its script, style and licences inside, and a C++ source that holds it."""

import argparse
import base64
import hashlib
import json
import re
from pathlib import Path


def licences(modules):
    """The licences of all packages whose code is in the page, by name."""
    parts = []
    for description in sorted(modules.glob("**/package.json")):
        folder = description.parent
        if folder.parent.name != "node_modules" and not folder.parent.name.startswith("@"):
            continue
        package = json.loads(description.read_text(encoding="utf-8"))
        if "version" not in package or package.get("name", "").startswith("@types/"):
            continue
        text = next((path.read_text(encoding="utf-8") for path in sorted(folder.iterdir())
                     if re.fullmatch(r"licen[cs]e(\.(md|txt))?", path.name, re.IGNORECASE)), package.get("license", ""))
        parts.append(f"{package['name']} {package['version']}\n\n{text.strip()}\n")
    return ("\n" + "-" * 72 + "\n\n").join(parts)


def hash_of(content):
    """As a policy for scripts and styles names it."""
    return "'sha256-" + base64.b64encode(hashlib.sha256(content.encode()).digest()).decode() + "'"


def within_script(text):
    """Nothing inside of a script element may end it, or begin a comment in it."""
    return re.sub(r"<(?=/script|!--)", r"\\x3c", text, flags=re.IGNORECASE)


def assembled(page, script, style, notes):
    script = "\n" + within_script(script).strip() + "\n"
    style = "\n" + re.sub(r"</(?=style)", r"<\\/", style, flags=re.IGNORECASE).strip() + "\n"
    policy = (f"default-src 'none'; script-src {hash_of(script)}; style-src {hash_of(style)}; img-src data: blob:; "
              "connect-src 'self'; base-uri 'none'; form-action 'none'")
    notes = notes.replace("<", "\u2039").replace(">", "\u203a")  # read as text, which must not end early
    for name, element in (
        ("policy", f'<meta http-equiv="Content-Security-Policy" content="{policy}">'),
        ("style", f"<style>{style}</style>"),
        ("licences", f'<script type="text/plain" id="licences">{notes}</script>'),
        ("script", f"<script>{script}</script>"),
    ):
        place = f"<!-- {name} -->"
        if page.count(place) != 1:
            raise SystemExit(f"page.html needs one '{place}'")
        page = page.replace(place, element)
    return page


def source_of(page):
    """Bytes as numbers: compilers limit the length of string literals."""
    data = page.encode()
    lines = [",".join(map(str, data[i : i + 40])) for i in range(0, len(data), 40)]
    return ("// Written by page/assemble.py.\n#include \"page/page_html.hpp\"\n\nnamespace graze {\nnamespace {\n\n"
            "constexpr unsigned char bytes[] = {\n" + ",\n".join(lines) + "};\n\n} // namespace\n\n"
            "std::string_view page_html() { return {reinterpret_cast<const char*>(bytes), sizeof bytes}; }\n\n"
            "} // namespace graze\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("page", "script", "style", "modules", "html", "source"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    given = parser.parse_args()
    read = lambda path: path.read_text(encoding="utf-8")
    page = assembled(read(given.page), read(given.script), read(given.style), licences(given.modules))
    given.html.write_text(page, encoding="utf-8")
    given.source.write_text(source_of(page), encoding="utf-8")


if __name__ == "__main__":
    main()
