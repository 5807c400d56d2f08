"""Types: what mypy says of a user's script, stubs that say what is there, annotations and docstrings of all that is
public."""

import importlib
import inspect
import os
import pathlib
import pkgutil
import re
import shutil
import subprocess
import sys

import pytest

import compiled_stub
import graze

HERE = pathlib.Path(__file__).resolve().parent
PACKAGE = pathlib.Path(graze.__file__).parent


def public(module):
    return sorted(name for name in vars(module) if not name.startswith("_") and not inspect.ismodule(getattr(module, name)))


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """Where mypy keeps what it knows, so that it reads the package only once."""
    return tmp_path_factory.mktemp("mypy")


def checked_by_mypy(cache, *arguments):
    mypy = shutil.which("mypy")
    if mypy is None:
        pytest.skip("mypy is not installed")
    return subprocess.run(
        [mypy, "--python-executable", sys.executable, "--cache-dir", str(cache), *arguments], capture_output=True,
        text=True, cwd=cache, env={**os.environ, "MYPYPATH": str(PACKAGE.parent)})


def test_a_script_of_a_user_has_right_types(cache):
    told = checked_by_mypy(cache, "--strict", "--follow-imports", "silent", str(HERE / "user_script.py"))
    assert told.returncode == 0, told.stdout + told.stderr
    wrong = cache / "wrong.py"
    wrong.write_text("import graze\nmodel = graze.Model.shipped('impact-oscillator')\ngraze.simulate(model, periods='x')\n"
                     "graze.simulate('x')\nmodel.nothing\n")
    told = checked_by_mypy(cache, "--strict", "--follow-imports", "silent", str(wrong))
    assert sorted(int(line) for line in re.findall(r"wrong.py:(\d+): error", told.stdout)) == [3, 4, 5], told.stdout


def test_the_script_of_a_user_runs():
    ended = subprocess.run([sys.executable, str(HERE / "user_script.py")], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    assert "time" in ended.stdout


def test_the_stub_of_the_compiled_part_says_what_is_there(cache):
    written = (PACKAGE / "_graze.pyi").read_text()
    assert written == compiled_stub.stub(), (
        "python3 tests/python/compiled_stub.py python/graze/_graze.pyi writes it anew")
    told = checked_by_mypy(cache, "--strict", "--follow-imports", "silent", str(PACKAGE / "_graze.pyi"))
    assert told.returncode == 0, told.stdout


def test_all_lists_the_public_names():
    assert sorted(graze.__all__) == public(graze), "graze.__all__ has to list them"


def functions_and_methods():
    for name in public(graze):
        thing = getattr(graze, name)
        if inspect.isfunction(thing):
            yield name, thing
        if inspect.isclass(thing) and thing.__module__.startswith("graze."):
            for attribute, member in vars(thing).items():
                member = getattr(member, "__func__", member.fget if isinstance(member, property) else member)
                if inspect.isfunction(member) and (not attribute.startswith("_") or attribute == "__init__"):
                    yield f"{name}.{attribute}", member


def test_all_that_is_public_has_annotations():
    missing = []
    for name, function in functions_and_methods():
        if "<locals>" in function.__qualname__ or "<string>" in function.__code__.co_filename:
            continue  # made by dataclasses and the like
        words = inspect.signature(function).parameters.values()
        named = [one for one in words if one.name not in ("self", "cls") and not one.name.startswith("_")]
        if any(one.annotation is one.empty for one in named) or "return" not in function.__annotations__:
            missing.append(name)
    assert missing == []


def test_all_that_is_public_has_docstrings():
    missing = [name for name in public(graze) if not inspect.getdoc(getattr(graze, name))]
    missing += [name for name, function in functions_and_methods()
                if not name.endswith(".__init__") and not inspect.getdoc(function)
                and "<locals>" not in function.__qualname__]
    assert missing == []


def test_nothing_heavy_is_imported():
    """numpy and its like are imported where they are needed."""
    text = "import sys, graze; print([one for one in sys.modules if one.split('.')[0] in "
    text += "('numpy', 'matplotlib', 'pandas', 'xarray', 'tqdm', 'scipy', 'concurrent', 'asyncio')])"
    told = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True).stdout
    assert told.strip() == "[]"


def test_each_module_can_be_imported_first():
    names = [one.name for one in pkgutil.iter_modules([str(PACKAGE)]) if one.name != "_graze"]
    assert "_motion" in names
    for name in names:
        subprocess.run([sys.executable, "-c", f"import graze.{name}"], check=True)
    assert importlib.import_module("graze").__version__
