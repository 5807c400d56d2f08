#!/usr/bin/env python3
"""Fails when two types of the same name are defined in two places: the linker takes either one for both, silently.

usage: check_names.py REPOSITORY
"""
import collections
import pathlib
import re
import sys

DEFINED = re.compile(r"^(?:struct|class) (\w+(?:<.*?>)?)(?: final)?(?: *:(?!:)[^;]*)? *\{")

root = pathlib.Path(sys.argv[1])
places = collections.defaultdict(list)
for source in sorted([*root.glob("include/**/*.hpp"), *root.glob("src/**/*.?pp")]):
    unnamed = False
    for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
        if line == "namespace {":
            unnamed = True
        elif line.startswith("}") and "namespace" in line:
            unnamed = False
        elif not unnamed and (found := DEFINED.match(line)):
            places[found[1]].append(f"{source.relative_to(root)}:{number}")
wrong = {name: where for name, where in places.items() if len(where) > 1}
for name, where in wrong.items():
    print(f"{name} is defined at {' and at '.join(where)}: give one of them another name.", file=sys.stderr)
if not places:
    sys.exit("there are no types")
sys.exit(1 if wrong else 0)
