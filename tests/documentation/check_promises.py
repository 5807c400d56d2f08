#!/usr/bin/env python3
"""Fails unless each promise of the pages about files has a test, and each named test exists.

usage: check_promises.py REPOSITORY

promises.txt has a section for each page, `[docs/PAGE.md]` or `[docs/PAGE.md: HEADING]`. In it each promise is a line, in
the words of the page, and the names of its tests are on indented lines below. If a section names a heading, every sentence under
that heading must be a promise.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
TEST = re.compile(r"^TEST(?:_[FP])?\((\w+),\s*(\w+)\)", re.M)


def words(text):
    """@return the text without marks of Markdown and line feeds"""
    text = re.sub(r"```.*?```", " ", text, flags=re.S)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return " ".join(text.replace("**", "").replace("`", "").split())


def part(page, heading):
    text = (root / page).read_text(encoding="utf-8")
    if not heading:
        return words(text)
    found = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", text, re.M | re.S)
    return words(found[1]) if found else sys.exit(f"{page} has no heading '{heading}'")


def check(place, promises, known):
    """@return a list of the mistakes in a section"""
    page, _, heading = place.partition(": ")
    text, wrong = part(page, heading), []
    for promise, tests in promises:
        if words(promise) not in text:
            wrong.append(f"{page} no longer contains the promise: {promise}")
        elif heading:
            text = text.replace(words(promise), "", 1)
        wrong += [f"{page}: there is no test {test} of: {promise}" for test in tests if test not in known]
        if not tests:
            wrong.append(f"{page}: promises.txt names no test of: {promise}")
    if heading and text.strip():
        wrong.append(f"{page}: promises.txt does not have these promises: {' '.join(text.split())}")
    return wrong


known = {f"{suite}.{name}" for source in root.glob("tests/**/*.cpp")
         for suite, name in TEST.findall(source.read_text(encoding="utf-8"))}
sections = {}
for line in (root / "tests/documentation/promises.txt").read_text(encoding="utf-8").splitlines():
    if line.startswith("["):
        sections[line[1:-1]] = current = []
    elif line.startswith(" "):
        current[-1][1].extend(line.split())
    elif line.strip() and not line.startswith("#"):
        current.append((line, []))
mistakes = [one for place, promises in sections.items() for one in check(place, promises, known)]
print(*mistakes, sep="\n", file=sys.stderr)
count = sum(len(promises) for promises in sections.values())
print(f"{count} promises")
sys.exit(1 if mistakes or count < 60 else 0)
