"""Writes docs/python-reference.md from the docstrings of the package `graze`.

usage: write_reference.py [FILE]
"""

import inspect
import pathlib
import re
import sys
import textwrap

import graze

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/python-reference.md"

# What is public and not named here comes under the last heading.
GROUPS = {
    "Models": ["Model", "load", "models", "Parameters", "Initial", "Finding"],
    "Parts of models written in Python": ["states", "parameters", "State", "Parameter", "Definition", "Mode", "Event", "Jump",
                                          "Transition", "Slide", "Friction", "Contact", "Contacts", "Section",
                                          "Symmetry", "Quantity", "Conserved", "Interpolant"],
    "Expressions": ["symbols", "expression", "Expression", "Condition", "sqrt", "exp", "log", "sin", "cos", "tan", "asin",
                    "acos", "atan", "sinh", "cosh", "tanh", "erf"],
    "One motion": ["simulate", "Simulation", "Motion"],
    "Many motions": ["sweep", "basin", "ensemble", "Sweep", "Basin", "Ensemble"],
    "Orbits, branches and curves": ["orbit", "equilibria", "follow", "curve", "ladder", "torus", "Orbit", "Equilibria", "Branch",
                                    "Point", "Curve", "Ladder", "Tori", "points"],
    "What a point leads to": ["Grazing", "CycleMap", "MapMotion", "Trips", "Tolerance", "LocatedSolution", "Chatter",
                              "Certificate"],
    "Records": ["read_record", "MeasuredRecord", "MeasuredRecords", "PeriodFit", "HarmonicFit", "record", "Record"],
    "Parameters from records": ["identify", "Identification", "decrement", "restitution", "coupling", "impedance",
                                "Estimates", "Estimate"],
    "Experiments": ["acquire", "Experiment", "Acquisition", "bench", "Bench", "BenchService"],
    "Design and layout": ["design", "designs", "design_text", "Design", "layout", "Layout", "LumpedModel", "ComparedDevice",
                          "Wafers", "mask_layers"],
    "Results and studies": ["Run", "Table", "Figure", "read_results", "run_study", "studies", "Study", "Figure"],
    "Errors": ["Error", "InputError", "ModelError", "StudyError", "FileError", "InstrumentError", "OrderError", "RunFailed",
               "WorkersLost", "InternalError", "Interrupted"],
}
OTHERS = "Others"
ALIKE = {"sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "erf"}
ENTRY = re.compile(r"^([a-z_]\w*(?:, [a-z_]\w*)*): (?=\S)")


def public_names() -> list:
    return sorted(name for name, value in vars(graze).items() if not name.startswith("_") and not inspect.ismodule(value))


def grouped() -> dict:
    known = {name for names in GROUPS.values() for name in names}
    groups = {title: [name for name in names if hasattr(graze, name)] for title, names in GROUPS.items()}
    groups[OTHERS] = [name for name in public_names() if name not in known]
    return {title: names for title, names in groups.items() if names}


def markdown(docstring: str) -> str:
    """A docstring as Markdown: examples become blocks of code, paragraphs of `names: meaning` become lists."""
    blocks = []
    for block in re.split(r"\n\s*\n", inspect.cleandoc(docstring)) if docstring else []:
        lines = block.splitlines()
        if lines[0].startswith(">>>") or all(line.startswith("    ") for line in lines):
            blocks.append("```python\n" + textwrap.dedent(block) + "\n```")
        elif ENTRY.match(lines[0]):
            entries = []
            for line in lines:
                if ENTRY.match(line):
                    entries.append(ENTRY.sub(lambda found: "- " + listed(found[1]) + ": ", line, count=1))
                else:
                    entries[-1] += " " + line.strip()
            blocks.append("\n".join(entries))
        else:
            blocks.append("\n".join(line.strip() for line in lines))
    return "\n\n".join(blocks)


def listed(names: str) -> str:
    return ", ".join(f"`{name.strip()}`" for name in names.split(","))


def signature(of, name: str) -> str:
    try:
        shown = inspect.signature(of)
    except (TypeError, ValueError):
        return f"{name}(...)"
    kept = [one.replace(annotation=inspect.Parameter.empty) for one in shown.parameters.values() if one.name != "self"]
    return name + str(shown.replace(parameters=kept, return_annotation=inspect.Signature.empty))


def own_members(of: type) -> list:
    """(name, member) of what a class, with its private bases, adds, in the order of the source."""
    found = {}
    for one in (of, *(base for base in of.__mro__[1:] if base.__module__.startswith("graze.") and not is_public(base))):
        for name, member in vars(one).items():
            if not name.startswith("_") or name == "__call__" and inspect.isfunction(member):
                found.setdefault(name, member)
    return list(found.items())


def is_public(of: type) -> bool:
    return vars(graze).get(of.__name__) is of


def described_class(of: type, name: str) -> list:
    lines = []
    based = [f"`{base.__name__}`" for base in of.__bases__ if is_public(base)]
    if based:
        lines += ["It has all that " + " and ".join(based) + " has.", ""]
    attributes, methods = [], []
    for member_name, member in own_members(of):
        text = member.__doc__
        if isinstance(member, property) and text:
            attributes.append(f"- `{member_name}`: {' '.join(text.split())}")
        elif (inspect.isfunction(member) or isinstance(member, (staticmethod, classmethod))) and text:
            called = "" if member_name == "__call__" else "." + member_name
            methods += [f"**`{signature(getattr(of, member_name), name + called)}`**", "", markdown(text), ""]
    if attributes:
        lines += ["More attributes:" if "Attributes:" in (of.__doc__ or "") else "Attributes:", "", *attributes, ""]
    return lines + methods


def page() -> str:
    lines = [
        "# Python reference",
        "",
        "Every public name of the module `graze`, with its docstring. `tests/python/write_reference.py` writes this page from the",
        "module, and a test checks that it is up to date. The [guide](python.md) shows how the parts belong together; in a",
        "notebook `help(graze.sweep)` and `graze.sweep?` show the same texts. Keyword arguments of runs that are not listed here",
        "(`**keys`) are the keys of [studies](study-format.md).",
        "",
    ]
    for title, names in grouped().items():
        lines += [f"## {title}", ""]
        for name in names:
            of = getattr(graze, name)
            if name in ALIKE:
                continue
            lines += [f"### {name}", ""]
            if not inspect.isclass(of) and callable(of):
                lines += ["```python", f"graze.{signature(of, name)}", "```", ""]
            lines += [markdown(of.__doc__ or ""), ""]
            if inspect.isclass(of):
                lines += described_class(of, name.lower())
        alike = [name for name in names if name in ALIKE]
        if alike:
            lines += ["### Functions", "", ", ".join(f"`{name}`" for name in alike) + ":", "",
                      "functions of an expression, which become an expression, or of a number.", ""]
    return "\n".join(lines).rstrip() + "\n"


if __name__ == "__main__":
    pathlib.Path(*sys.argv[1:2] or [PAGE]).write_text(page(), encoding="utf-8")
