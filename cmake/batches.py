#!/usr/bin/env python3
"""Which sources can be compiled or looked at as one, since their own names do not collide.

usage: batches.py MOST SOURCE...

Prints one line a source, `BATCH;SOURCE`, with at most MOST in a batch.
"""
import pathlib
import re
import sys

# What begins in the first column and declares something: a function, a constant, a type or another name for one.
DECLARED = re.compile(r"^(?:\[\[\w+\]\] )?(?:(?:struct|class|enum class) (\w+)|using (\w+) =|(?!using |namespace )[A-Za-z][^=;(){]*?\b(\w+)(?=[({=;]| =|\[))")


def own_names(source):
    """Names that no other source may have beside this one: those of its unnamed namespaces."""
    names = set()
    inside = False
    for line in pathlib.Path(source).read_text(encoding="utf-8").splitlines():
        if line == "namespace {":
            inside = True
        elif line.startswith("}") and line.endswith("// namespace"):
            inside = False
        elif inside and (found := DECLARED.match(line)):
            names.add(found[1] or found[2] or found[3])
            # `constexpr double one = 1, other = 2;`
            if line.startswith("const"):
                names.update(re.findall(r", (\w+) = ", line))
    return names


def used_names(source):
    """Names that a source calls or takes for types, wherever they are declared: an own name of another source before it
    would hide them."""
    text = pathlib.Path(source).read_text(encoding="utf-8")
    text = re.sub(r'"(?:\\.|[^"\\])*"', '""', re.sub(r"//.*", "", text))
    return set(re.findall(r"(?<![\w.:>])(\w+)(?=[(<{]|::)", text))


def batches_of(sources, most):
    """The sources, each in the first batch that has room and in which no name hides another. Folders stay together as
    far as that goes: they include the same."""
    batches = []
    for source in sources:
        own, used = own_names(source), used_names(source)
        for members, taken, needed in batches:
            if len(members) < most and not own & (taken | needed) and not used & taken:
                members.append(source)
                taken |= own
                needed |= used
                break
        else:
            batches.append(([source], own, used))
    return [batch[0] for batch in batches]


if __name__ == "__main__":
    for number, batch in enumerate(batches_of(sys.argv[2:], int(sys.argv[1]))):
        for member in batch:
            print(f"{number};{member}")
