"""Runs that functions asked for, written as the study that computes them, with the files that it needs."""

from __future__ import annotations

import glob
import os
import shutil
from typing import Any, Dict, Iterable, Tuple

from . import _graze
from ._errors import FileError, InputError
from ._keywords import RunText, study_text
from ._output import Path, made_folder, write_file, writing


def write_study(folder: Path, runs: Iterable[RunText], models: Dict[str, Tuple[str, Any]]) -> str:
    """Writes a study of these runs, with its models and the files that it reads, into a folder. Existing files are
    replaced. Returns the path of the study."""
    place = made_folder(folder)
    path = os.path.join(place, "study.toml")
    written = []
    with writing(place):
        for run in runs:
            keys = dict(run.given)
            if "model" in keys:
                keys["model"] = _written_model(place, keys["model"], models[keys["model"]][0])
            for key in ("files", "table"):
                if key in keys:
                    _copy_inputs(keys[key], run.folder, place)
            written.append(RunText(run.name, run.kind, keys))
        write_file(path, study_text("python", written))
    return path


def _written_model(folder: str, name: str, text: str) -> str:
    """What a study calls a model: the name of a shipped one that is the same, or the file to which it is written."""
    try:
        if name in dict(_graze.shipped_models()) and _graze.Model.loaded(name).text() == text:
            return name
    except InputError:
        pass
    file = "".join(c if c.isalnum() or c in "._-" else "_" for c in name) + ".toml"
    file = f"model-{file}" if file == "study.toml" or file.startswith(".") else file
    write_file(os.path.join(folder, file), text)
    return f"./{file}"


def _copy_inputs(named: Any, source: Path, folder: str) -> None:
    """Copies files that a run reads to the same relative places in a folder. FileError where there are none."""
    place = os.fspath(source)
    if hasattr(named, "items"):
        named = [one for some in named.values() for one in ([some] if isinstance(some, str) else some)]
    for pattern in [named] if isinstance(named, (str, os.PathLike)) else named:
        paths = glob.glob(os.path.join(glob.escape(place), os.fspath(pattern)))
        if not paths:
            raise FileError(f"there is no file '{os.path.join(place, os.fspath(pattern))}' any more",
                            "put it back: the study needs it")
        for path in paths:
            target = os.path.join(folder, os.path.relpath(path, place or "."))
            os.makedirs(os.path.dirname(target) or ".", exist_ok=True)
            if not (os.path.exists(target) and os.path.samefile(path, target)):
                shutil.copyfile(path, target)
