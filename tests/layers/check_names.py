#!/usr/bin/env python3
"""Fails when two types of the same name are defined in two places, since the linker silently takes either one for both;
and when tests/sanitizers/long_tests names a suite or test that does not exist.

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

tests = set()
for source in root.glob("tests/**/*.cpp"):
    for suite, test in re.findall(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", source.read_text(encoding="utf-8"), re.MULTILINE):
        tests.add(f"{suite}.{test}")
lines = (root / "tests/sanitizers/long_tests").read_text(encoding="utf-8").splitlines()
# In lower case, or with ^, are tests that are not compiled.
stale = [one for one in lines if re.match("[A-Z]", one) and not any(re.search(one, test) for test in tests)]
for one in stale:
    print(f"tests/sanitizers/long_tests: there is no test {one}", file=sys.stderr)
sys.exit(1 if wrong or stale else 0)
