"""Runs the snippets of the documentation and the notebooks, and checks the pages that are made from the module."""

import contextlib
import doctest
import importlib.util
import inspect
import io
import json
import os
import pathlib
import re
import subprocess
import time

import pytest

import graze
import run_notebook
import write_reference

ROOT = pathlib.Path(__file__).resolve().parents[2]
REFERENCE = "docs/python-reference.md"  # made from docstrings, whose examples have a test of their own
PAGES = ["README.md", *sorted(f"docs/{path.name}" for path in (ROOT / "docs").glob("python*.md"))]
PAGES.remove(REFERENCE)
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


def blocks(page: pathlib.Path):
    """(line, language and purpose, text) of each fenced block."""
    found, start, words, lines = [], 0, None, []
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if not line.startswith("```"):
            lines.append(line)
        elif words is None:
            start, words, lines = number, line[3:].strip(), []
        else:
            found.append((start, words, "\n".join(lines) + "\n"))
            words = None
    assert words is None, f"{page}:{start}: the block never ends"
    return found


def run_page(page: pathlib.Path) -> int:
    """Runs the blocks of Python in order, and compares what each prints with a block of text that follows it.

    ```python               is run
    ```python needs=MODULE  is run if that module is installed
    ```python not-run       is not run
    ```text                 right after a block that was run: what it prints
    """
    names, ran, printed = {"__name__": "__main__"}, 0, None
    for line, words, text in blocks(page):
        language, _, purpose = words.partition(" ")
        if language == "text" and not purpose and printed is not None:
            assert printed == text, f"{page.name}:{line}: the snippet before prints\n{printed}"
            printed = None
            continue
        printed = None
        if language != "python" or purpose == "not-run":
            continue
        if purpose.startswith("needs=") and importlib.util.find_spec(purpose[len("needs="):]) is None:
            continue
        assert not purpose or purpose.startswith("needs="), f"{page.name}:{line}: unknown purpose {purpose}"
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            # The lines before make the line numbers of tracebacks those of the page.
            exec(compile("\n" * line + text, str(page), "exec"), names)
        printed, ran = output.getvalue(), ran + 1
    return ran


@pytest.mark.parametrize("page", PAGES)
def test_snippets_run_and_print_what_is_shown(page, tmp_path, monkeypatch):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.chdir(tmp_path)
    assert run_page(ROOT / page) > 0 or page == "docs/python-commands.md"
    pyplot.close("all")


def test_wrong_output_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("```python\nprint(1)\n```\n\n```text\n2\n```\n", encoding="utf-8")
    with pytest.raises(AssertionError):
        run_page(page)
    page.write_text("```python not-run\nprint(1)\n```\n\n```text\n2\n```\n", encoding="utf-8")
    assert run_page(page) == 0


def test_the_reference_is_up_to_date():
    written = write_reference.PAGE.read_text(encoding="utf-8")
    assert written == write_reference.page(), "run tests/python/write_reference.py, with PYTHONPATH as for this test"


def test_the_reference_has_every_public_name():
    page = write_reference.PAGE.read_text(encoding="utf-8")
    for name in write_reference.public_names():
        assert f"\n### {name}\n" in page or f"`{name}`" in page, name


def test_every_public_name_has_a_docstring():
    missing = []
    for name in write_reference.public_names():
        of = getattr(graze, name)
        if not inspect.getdoc(of):
            missing.append(name)
        if inspect.isclass(of) and of is not graze.Expression:  # numpy calls its methods
            missing += [f"{name}.{member}" for member, value in vars(of).items()
                        if inspect.isfunction(value) and not member.startswith("_") and not inspect.getdoc(value)]
    assert not missing


def test_examples_of_docstrings_hold():
    finder, runner = doctest.DocTestFinder(), doctest.DocTestRunner()
    for name in write_reference.public_names():
        of = getattr(graze, name)
        if inspect.isclass(of) or inspect.isfunction(of):
            for test in finder.find(of, name, module=False, globs={**vars(graze), "graze": graze}):
                runner.run(test)
    assert runner.summarize().failed == 0


def commands_of_the_program() -> set:
    """The commands that the sources of the program declare."""
    sources = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "src/program").glob("*.cpp"))
    return set(re.findall(r'(?:\.command\(|declare_of_point\(line, )"([a-z]+)"', sources))


def resolved(dotted: str):
    """What `graze.sweep`, or `Point.switch` of a class of graze, stands for."""
    names = dotted.split(".")
    of = graze if names[0] == "graze" else getattr(graze, names[0])
    for name in names[1:]:
        of = getattr(of, name)
    return of


def test_every_command_has_its_equal():
    page = (ROOT / "docs/python-commands.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `graze ([a-z]+)[^|]*\| (.*) \|$", page, re.MULTILINE)
    commands = commands_of_the_program()
    assert {"simulate", "ladder", "acquire", "help"} <= commands
    assert {command for command, _ in rows} == commands
    for command, equal in rows:
        names = re.findall(r"`((?:graze|[A-Z]\w+)(?:\.\w+)+)", equal)
        assert names or "help(" in equal or "no equal" in equal, command
        for name in names:
            resolved(name)


def test_names_in_the_text_exist():
    texts = {page: (ROOT / page).read_text(encoding="utf-8") for page in [*PAGES, "CHANGELOG.md"]}
    texts |= {notebook.name: notebook.read_text(encoding="utf-8") for notebook in NOTEBOOKS}
    for page, text in texts.items():
        for name in re.findall(r"`graze\.([A-Za-z]\w*)", text):
            assert hasattr(graze, name), f"{page}: graze.{name}"


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_kept_without_outputs(notebook):
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    assert cells[0]["cell_type"] == "markdown"
    assert cells[0]["source"][0].startswith("# ")
    for cell in cells:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            assert cell["execution_count"] is None


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run(notebook, tmp_path):
    if "asan" in os.environ.get("LD_PRELOAD", ""):
        pytest.skip("under the address sanitizer notebooks take minutes")
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    begin = time.monotonic()
    try:
        page = run_notebook.run(notebook, tmp_path)
    except subprocess.CalledProcessError as error:
        pytest.fail(error.stderr)
    assert time.monotonic() - begin < 60
    pictures = re.findall(r"!\[[^]]*\]\((\S+)\)", page.read_text(encoding="utf-8"))
    # A line that ends in `;` draws, and shows nothing but the picture.
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    drawn = sum("".join(cell["source"]).endswith(";") for cell in cells if cell["cell_type"] == "code")
    assert len(pictures) == drawn >= 2
    assert all((tmp_path / picture).stat().st_size > 5000 for picture in pictures)


def test_notebooks_are_on_the_site():
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    for notebook in NOTEBOOKS:
        assert f"notebooks/{notebook.stem}.md" in navigation
    for page in [*PAGES, REFERENCE]:
        assert page in navigation
