"""Runs a notebook with this interpreter, and writes it with its outputs.

usage: run_notebook.py NOTEBOOK FOLDER [markdown | notebook]

Without a third word it becomes a page of Markdown with its pictures beside it.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def run(notebook, folder, form="markdown") -> pathlib.Path:
    """The file that was written. Raises CalledProcessError, whose `stderr` has the error of the notebook."""
    notebook, folder = pathlib.Path(notebook), pathlib.Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as private:
        # The kernel is this interpreter, whatever kernels the user has installed.
        kernel = pathlib.Path(private, "kernels", "python3")
        kernel.mkdir(parents=True)
        arguments = [sys.executable, "-Xfrozen_modules=off", "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        (kernel / "kernel.json").write_text(
            json.dumps({"argv": arguments, "display_name": "Python 3", "language": "python"}), encoding="utf-8"
        )
        # Where it runs, it may leave files.
        copy = pathlib.Path(shutil.copy(notebook, private))
        environment = {**os.environ, "JUPYTER_PATH": private, "IPYTHONDIR": private, "PYDEVD_DISABLE_FILE_VALIDATION": "1"}
        # The kernel runs elsewhere: folders that are searched for modules need their whole names.
        searched = [os.path.abspath(one) for one in environment.get("PYTHONPATH", "").split(os.pathsep) if one]
        environment["PYTHONPATH"] = os.pathsep.join(searched)
        environment.pop("MPLBACKEND", None)  # pictures go into the notebook
        subprocess.run(
            [sys.executable, "-m", "nbconvert", "--to", form, "--execute", str(copy), "--output-dir", str(folder),
             "--ExecutePreprocessor.timeout=120"],
            check=True, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
    if form == "notebook":
        return folder / notebook.name
    page = folder / f"{notebook.stem}.md"
    text = page.read_text(encoding="utf-8")
    title = re.search(r"^# (.*)$", text, re.MULTILINE)
    page.write_text(re.sub(r"!\[(?:png|svg)\]\(", lambda _: f"![{title[1]}](", text), encoding="utf-8")
    return page


if __name__ == "__main__":
    try:
        print(run(*sys.argv[1:4]))
    except subprocess.CalledProcessError as error:
        sys.exit(error.stderr)
