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


class Names:
    """Names of one source, or of several that go together."""

    def __init__(self, source):
        text = pathlib.Path(source).read_text(encoding="utf-8")
        self.own = set()  # of its unnamed namespaces
        self.constants = set()  # among them
        inside = False
        for line in text.splitlines():
            if line == "namespace {":
                inside = True
            elif line.startswith("}") and line.endswith("// namespace"):
                inside = False
            elif inside and (found := DECLARED.match(line)):
                self.own.add(found[1] or found[2] or found[3])
                if line.startswith("const"):  # `constexpr double one = 1, other = 2;`
                    self.constants.update([found[3], *re.findall(r", (\w+) = ", line)])
        self.own |= self.constants
        text = re.sub(r'"(?:\\.|[^"\\])*"', '""', re.sub(r"//.*", "", text))
        # What is called or taken for a type, and all that may be a constant, wherever these are declared.
        self.called = set(re.findall(r"(?<![\w.:>])(\w+)(?=[(<{]|::)", text))
        self.mentioned = set(re.findall(r"(?<![\w.:>])(\w+)", text))

    def hide(self, other):
        """Whether a name of the one would stand in the way of the other."""
        return any(
            (one.own & (two.own | two.called)) or (one.constants & two.mentioned)
            for one, two in ((self, other), (other, self))
        )

    def add(self, other):
        for kind in ("own", "constants", "called", "mentioned"):
            getattr(self, kind).update(getattr(other, kind))


def batches_of(sources, most):
    """The sources, each in the first batch that has room and in which no name hides another. Folders stay together as
    far as that goes: they include the same."""
    batches = []
    for source in sources:
        names = Names(source)
        for members, taken in batches:
            if len(members) < most and not taken.hide(names):
                members.append(source)
                taken.add(names)
                break
        else:
            batches.append(([source], names))
    return [members for members, _ in batches]


if __name__ == "__main__":
    for number, batch in enumerate(batches_of(sys.argv[2:], int(sys.argv[1]))):
        for member in batch:
            print(f"{number};{member}")
