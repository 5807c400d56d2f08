#!/usr/bin/env python3
"""Checks, or writes, the tables of keys in the pages, which must equal the program's descriptions.

usage: check_keys.py PROGRAM PAGE...           fails where a table differs
       check_keys.py --write PROGRAM PAGE...   writes the tables

A table follows a line `<!-- keys of KIND: NAME, NAME, ... -->`. The tables of a kind, together with the keys that are
described in the text (`<!-- told in words, of KIND: NAME, ... -->`), must have all of its keys.
"""
import csv
import io
import pathlib
import re
import subprocess
import sys

MARK = re.compile(r"<!-- keys of ([\w, ]+): ([\w, ]+) -->\n\n((?:\|.*\n)*)")
TOLD = re.compile(r"<!-- told in words, of ([\w, ]+): ([\w, ]+) -->")


def names(text):
    return [one.strip() for one in text.split(",")]


def row(key):
    words = names(key["type"]) if key["meaning"] and "," in key["type"] and not re.search(r'[{"\[]', key["type"]) else []
    name, default = key["key"], key["default"]
    shown = f"`{name} = {key['type']}`" if re.search(r'[{"\[]', key["type"]) else f"`{name}`"
    meaning = key["meaning"]
    if words:
        meaning = ", ".join(f"`{word}`" for word in words[:-1]) + f" or `{words[-1]}`: " + meaning
    if default:
        quoted = words or default in ("true", "false") or key["type"] == "text"
        meaning += f" (`{default}`)" if quoted else f" ({default})"
    return f"| {shown} | {meaning} |\n"


def main():
    write = sys.argv[1] == "--write"
    program, pages = sys.argv[1 + write], sys.argv[2 + write :]
    text = subprocess.run([program, "run", "--keys", "all", "--format", "csv"], check=True, capture_output=True, text=True).stdout
    keys = {}
    for one in csv.DictReader(io.StringIO(text)):
        keys.setdefault(one["kind"], {})[one["key"]] = one
    told = {kind: set() for kind in keys}
    wrong = False
    for page in map(pathlib.Path, pages):
        contents = page.read_text(encoding="utf-8")
        for found in TOLD.finditer(contents):
            for kind in names(found[1]):
                told[kind].update(names(found[2]))

        def table(found):
            kinds, chosen = names(found[1]), names(found[2])
            for kind in kinds:
                told[kind].update(chosen)
            rows = "| Key | Meaning |\n|---|---|\n" + "".join(row(keys[kinds[0]][name]) for name in chosen)
            return f"<!-- keys of {found[1]}: {found[2]} -->\n\n{rows}"

        made = MARK.sub(table, contents)
        if made != contents and write:
            page.write_text(made, encoding="utf-8")
        elif made != contents:
            print(f"{page}: tables of keys differ from the program's; run {sys.argv[0]} --write PROGRAM {page}", file=sys.stderr)
            wrong = True
    for kind, known in keys.items():
        for name in sorted(set(known) - told[kind]):
            print(f"no table has the key `{name}` of runs of kind \"{kind}\"", file=sys.stderr)
            wrong = True
        for name in sorted(told[kind] - set(known)):
            print(f"runs of kind \"{kind}\" have no key `{name}`, which a table has", file=sys.stderr)
            wrong = True
    return wrong


if __name__ == "__main__":
    sys.exit(main())
