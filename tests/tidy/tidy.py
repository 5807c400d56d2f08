#!/usr/bin/env python3
"""Runs clang-tidy on all sources, several at once: what they include is parsed once and not for each. Also compiles every
public header by itself.

usage: tidy.py BUILD OUTPUT JOBS [--recent] [OPTION...]

BUILD has compile_commands.json; what is put together goes to OUTPUT. With --recent only what was changed in the twelve
hours before the newest commit, and since, is looked at. Sources whose own names collide are never put together; where
that was not seen, a batch is looked at in halves. Other options go to clang-tidy.
"""
import concurrent.futures
import itertools
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "cmake"))
sys.path.insert(0, str(ROOT / "tests/layers"))
import check_headers  # noqa: E402
from batches import batches_of  # noqa: E402

MOST = 40  # sources in a batch


def batch_text(sources):
    """All in one; an include that an earlier source has is left out, so that none is told to be there twice."""
    seen = set()
    lines = []
    for source in sources:
        lines.append(f'#line 1 "{source}"')
        own = set()
        for line in pathlib.Path(source).read_text(encoding="utf-8").splitlines():
            if line.startswith("#include"):
                skipped = line in seen - own
                own.add(line)
                seen.add(line)
                line = "" if skipped else line
            lines.append(line)
    return "\n".join(lines) + "\n"


def look_at(batch, build, output, options):
    """What clang-tidy finds, and whether that is nothing."""
    first = batch[0]
    source = pathlib.Path(first["file"])
    folder = output / f"{source.parent.name}_{source.stem}_{len(batch)}"
    if len(batch) > 1:
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / source.name
        path.write_text(batch_text([c["file"] for c in batch]), encoding="utf-8")
        # All that any of them is given, and the headers that lie beside them.
        words = dict.fromkeys(
            word for c in batch for word in re.findall(r"(?<=\s)(?:-D\S+|-I\S+|-isystem \S+)", c["command"])
        )
        words.update(dict.fromkeys(f"-iquote{pathlib.Path(c['file']).parent}" for c in batch))
        command = " ".join([first["command"].replace(first["file"], str(path)), *words])
        (folder / "compile_commands.json").write_text(json.dumps([dict(first, file=str(path), command=command)]))
        words = ["clang-tidy", "--quiet", f"--config-file={ROOT}/.clang-tidy", "-p", str(folder)]
        # A name of one source may well be a local one of the next.
        words += ["--extra-arg=-Wno-shadow", *options, str(path)]
    else:
        words = ["clang-tidy", "--quiet", "-p", str(build), *options, first["file"]]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    # Whatever is found is told of a source alone: it may come from looking at several.
    if len(batch) > 1 and done.returncode != 0:
        middle = len(batch) // 2
        halves = [look_at(half, build, output, options) for half in (batch[:middle], batch[middle:])]
        return "".join(text for text, _ in halves), all(clean for _, clean in halves)
    return done.stdout + (done.stderr if done.returncode else ""), done.returncode == 0


def header_compiler(output):
    """Returns a function that says what clang finds in a header that is compiled by itself, with nothing but the public
    headers, and whether that is nothing. The standard library is parsed once: tests/layers/check_headers.py checks that
    headers include what they use of it."""
    words = ["clang++", "-std=c++20", f"-I{ROOT}/include"]
    text = "".join(f"#include <{name}>\n" for name in check_headers.NAMES)
    (output / "standard.hpp").write_text(text, encoding="utf-8")
    prefix = str(output / "standard.pch")
    subprocess.run([*words, "-x", "c++-header", str(output / "standard.hpp"), "-o", prefix], check=True)
    words += ["-fsyntax-only", "-Wno-pragma-once-outside-header", "-include-pch", prefix]

    def compile_header(header):
        done = subprocess.run([*words, str(header)], capture_output=True, text=True, check=False)
        return done.stderr, done.returncode == 0

    return compile_header


def git(*words):
    return subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=True).stdout


def recently_changed():
    """Files that commits of the last twelve hours before the newest one changed, and those that are not committed."""
    begin = int(git("log", "-1", "--format=%ct")) - 12 * 3600
    names = git("log", f"--since={begin}", "--name-only", "--format=").splitlines()
    names += git("diff", "HEAD", "--name-only").splitlines()
    names += git("ls-files", "--others", "--exclude-standard").splitlines()
    return {ROOT / name for name in names if name}


def main(build, output, jobs, options):
    looked_at = None
    if "--recent" in options:
        options.remove("--recent")
        looked_at = recently_changed()
    commands = json.loads((build / "compile_commands.json").read_text())
    own = {}
    alone = []
    for command in sorted(commands, key=lambda c: c["file"]):
        source = pathlib.Path(command["file"])
        # Kernels are one text, compiled for several processors.
        if not source.is_relative_to(ROOT / "src") or source.name in ("jet_avx2.cpp", "jet_avx512.cpp"):
            continue
        if looked_at is not None and source not in looked_at:
            continue
        if source.name == "jet_baseline.cpp":
            alone.append(command)
        else:
            own[command["file"]] = command
    batches = [[command] for command in alone]
    # Sources of a folder include the same headers.
    for _, files in itertools.groupby(own, lambda file: pathlib.Path(file).parent):
        batches += [[own[file] for file in batch] for batch in batches_of(list(files), MOST)]
    headers = [header for header in sorted((ROOT / "include").rglob("*.hpp")) if looked_at is None or header in looked_at]
    output.mkdir(parents=True, exist_ok=True)
    compile_header = header_compiler(output)
    clean = True
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        looks = pool.map(lambda batch: look_at(batch, build, output, options), batches)
        for text, good in itertools.chain(looks, pool.map(compile_header, headers)):
            print(text, end="", flush=True)
            clean = clean and good
    if not own and looked_at is None:
        sys.exit("there are no sources")
    print(f"{len(own) + len(alone)} sources and {len(headers)} headers were looked at")
    sys.exit(0 if clean else 1)


main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), int(sys.argv[3]), sys.argv[4:])
