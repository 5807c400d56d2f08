"""Checks the site that mkdocs has built: links lead to files and anchors that exist, the navigation has every page, and the
pages contain no Markdown that mkdocs has not understood.

usage: check_site.py FOLDER_OF_PAGES FOLDER_OF_HTML
"""

import html.parser
import pathlib
import re
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.anchors, self.leftovers = [], set(), []
        self.code = 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.code += tag in ("code", "pre", "script", "style")
        if attributes.get("id"):
            self.anchors.add(attributes["id"])
        for name in ("href", "src"):
            if attributes.get(name):
                self.links.append(attributes[name])

    def handle_endtag(self, tag):
        self.code -= tag in ("code", "pre", "script", "style")

    def handle_data(self, text):
        if self.code:
            return
        for line in text.splitlines():
            # A table, a list or a block of code that mkdocs has taken for a paragraph.
            if re.match(r"\s*(\||[-*] \w|```)", line) or "`" in line or re.search(r"\]\(\S+\)", line):
                self.leftovers.append(line.strip())


def main(sources, site):
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    wrong, links = [], 0
    for path, page in pages.items():
        wrong += [f"{path}: Markdown that was not understood: {line}" for line in page.leftovers]
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            links += 1
            if parts.scheme in ("http", "https") and parts.path.endswith((".js", ".css")):
                wrong.append(f"{path}: {link} is fetched from elsewhere")
            if parts.scheme or parts.netloc or path.name == "404.html":
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file():
                wrong.append(f"{path}: the target of the link {link} does not exist")
            elif parts.fragment and target in pages and parts.fragment not in pages[target].anchors:
                wrong.append(f"{path}: {target.name} has no anchor {parts.fragment}")

    start = pages[site / "index.html"]
    reached = {(site / urllib.parse.urlsplit(link).path).resolve() for link in start.links}
    for source in sorted(sources.rglob("*.md")):
        page = source.relative_to(sources).with_suffix(".html")
        page = page.with_name("index.html") if page.stem == "README" else page
        if site / page not in reached:
            wrong.append(f"{source.relative_to(sources)} is missing in the navigation of mkdocs.yml")
    print(f"{len(pages)} pages, {links} links looked at")
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


sys.exit(main(*(pathlib.Path(folder).resolve() for folder in sys.argv[1:3])))
