#!/usr/bin/env python3
"""Groups sources into batches that can be compiled, or checked, as one source, because their private names do not collide.

usage: batches.py MOST SOURCE...

Prints one line for each source, `BATCH;SOURCE`, with at most MOST sources in a batch.
"""
import itertools
import pathlib
import re
import sys

# A line that declares a name in the first column: a function, a constant, a type or an alias.
DECLARED = re.compile(r"^(?:\[\[\w+\]\] )?(?:(?:struct|class|enum class) (\w+)|using (\w+) =|(?!using |namespace )[A-Za-z][^=;(){]*?\b(\w+)(?=[({=;]| =|\[))")


class Names:
    """The names of one source."""

    def __init__(self, source):
        text = pathlib.Path(source).read_text(encoding="utf-8")
        self.own = set()  # declared in unnamed namespaces
        self.constants = set()  # those of them that are constants
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
        # Names that are used as a function or type, and all names that may be constants, wherever they are declared.
        self.called = set(re.findall(r"(?<![\w.:>])(\w+)(?=[(<{]|::)", text))
        self.mentioned = set(re.findall(r"(?<![\w.:>])(\w+)", text))

    def hide(self, other):
        """True if a private name of one source would hide a name that the other declares or uses."""
        return any(
            (one.own & (two.own | two.called)) or (one.constants & two.mentioned)
            for one, two in ((self, other), (other, self))
        )


def batches_of(sources, most):
    """Puts each source into the first batch that is not full and in which no name hides another. Sources with many
    conflicts come first, which leads to few batches."""
    names = {source: Names(source) for source in sources}
    conflicts = {source: set() for source in sources}
    for one, other in itertools.combinations(sources, 2):
        if names[one].hide(names[other]):
            conflicts[one].add(other)
            conflicts[other].add(one)
    batches = []
    for source in sorted(sources, key=lambda one: -len(conflicts[one])):
        for batch in batches:
            if len(batch) < most and not conflicts[source].intersection(batch):
                batch.append(source)
                break
        else:
            batches.append([source])
    return batches


if __name__ == "__main__":
    for number, batch in enumerate(batches_of(sys.argv[2:], int(sys.argv[1]))):
        for member in batch:
            print(f"{number};{member}")
