import os
import pickle
import shutil
import sqlite3
import subprocess
import sys
import time

import numpy
import pytest

import graze

STUDY = """name = "small"
text = "two runs, a picture and a table"
model = "impact-oscillator"

[runs.swept]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.8, points = 11 } }
cycles = 80

[runs.rest]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }

[runs.free]
kind = "continue"
start = { run = "rest" }
along = { omega = [2.2, 4.5] }
direction = "down"

[runs.impacting]
kind = "continue"
start = { run = "free", point = "GR1" }
along = { omega = [2.2, 4.5] }

[tables.points]
runs = ["free", "impacting"]
points = ["GR", "PD"]
columns = ["omega", "period"]

[pictures.branches]
kind = "branch"
runs = ["free", "impacting"]
"""


def program():
    """The program that is built beside the module, or another one of the same version."""
    beside = os.path.join(os.path.dirname(graze._graze.__file__), "..", "..", "bin", "graze")
    found = beside if os.path.exists(beside) else shutil.which("graze")
    if not found:
        pytest.skip("the program is not built")
    return found


def tables(study):
    """All numbers of a study."""
    return {(name, what): run.table(what) for name, run in study.items()
            for what in (("points", "segments", "multipliers") if isinstance(run, graze.Branch) else ("points", "samples"))}


@pytest.fixture(scope="module")
def study():
    return graze.run_study(STUDY)


@pytest.fixture(scope="module")
def by_program(tmp_path_factory):
    folder = tmp_path_factory.mktemp("program")
    (folder / "small.toml").write_text(STUDY)
    subprocess.run([program(), "run", folder / "small.toml", "--output", folder / "out", "--no-pictures", "--quiet"],
                   check=True)
    return folder


def test_a_study_gives_the_numbers_of_the_program(study, by_program):
    results = graze.read_results(by_program / "out")
    assert list(results) == list(study) == ["swept", "rest", "free", "impacting"]
    assert tables(results) == tables(study)
    assert results.name == "small" and results.text == "two runs, a picture and a table"
    assert type(results["swept"]) is graze.Sweep and type(results["rest"]) is graze.Orbit
    assert results["free"]["GR1"].parameter == study["free"]["GR1"].parameter
    assert results["free"].ends() == study["free"].ends() != {}
    assert "swept (sweep, complete)" in repr(results)
    with pytest.raises(KeyError, match="there are swept, rest"):
        results["nowhere"]
    assert "nowhere" not in results and len(results) == 4


def test_studies_are_named_by_texts_paths_and_names(study, tmp_path):
    (tmp_path / "small.toml").write_text(STUDY)
    of_file = graze.run_study(tmp_path / "small.toml", output=tmp_path / "out")
    assert tables(of_file) == tables(study)
    assert of_file.path == str(tmp_path / "out" / "results.sqlite")
    assert "mems-switch" in graze.studies()
    some = graze.run_study("mems-switch", only="no_impact")
    assert list(some) == ["free", "no_impact"]  # with the run that it needs
    assert [report["name"] for report in some.reports] == ["free", "no_impact"]
    mine = graze.Model.shipped("impact-oscillator", e=0.7)
    named = graze.run_study(STUDY.replace('"impact-oscillator"', '"mine"'), models={"mine": mine}, only=["free"])
    assert named["free"].model.parameters.e == 0.7
    for wrong in ("nowhere", "name = 1\n", STUDY + "[runs.a]\nkind = 'swep'\n", tmp_path / "nowhere.toml"):
        with pytest.raises(graze.InputError):
            graze.run_study(wrong)
    with pytest.raises(graze.StudyError):
        graze.run_study("mems-switch", models={"mine": mine})
    with pytest.raises(graze.InputError):
        graze.run_study("mems-switch", only="nowhere")


def test_values_are_set_and_kept_apart(tmp_path):
    results = graze.run_study(STUDY, only="rest", set={"e": 0.7}, output=tmp_path)
    assert results["rest"].point.parameters["e"] == 0.7
    with pytest.raises(graze.InputError, match="e = 0.7"):
        graze.run_study(STUDY, only="rest", output=tmp_path)
    for wrong in ({"q": 1}, {"e": "a"}, {"e": True}):
        with pytest.raises(graze.StudyError):
            graze.run_study(STUDY, only="rest", set=wrong)


def test_what_is_there_is_not_computed_again(tmp_path):
    first = graze.run_study(STUDY, output=tmp_path)
    again = graze.run_study(STUDY, output=tmp_path)
    assert [report["computed"] for report in first.reports][0] == 11
    assert [report["computed"] for report in again.reports][0] == 0
    assert tables(again) == tables(first)
    del first, again
    swept = STUDY.replace("points = 11", "points = 3")
    assert len(graze.run_study(swept, output=tmp_path)["swept"].points) == 3


def test_tables_and_pictures_of_a_study(study, by_program, tmp_path):
    assert study.tables == ("points",) and study.pictures == ("branches",)
    table = study.table("points")
    assert table["run"][0] == "free" and table["label"][0] == "GR1"
    assert table["omega"][0] == study["free"]["GR1"].parameter
    paths = study.write_tables(tmp_path)
    subprocess.run([program(), "run", by_program / "small.toml", "--output", tmp_path / "again", "--quiet"], check=True)
    assert open(paths[0], encoding="utf-8").read() == (tmp_path / "again" / "points.csv").read_text(encoding="utf-8")
    axes = study.plot("branches")
    assert len(numpy.atleast_1d(axes).ravel()[0].lines) > 0
    written = study.write_pictures(tmp_path)
    assert [os.path.basename(path) for path in written] == ["branches.png"] and os.path.getsize(written[0]) > 1000
    for wrong in (study.plot, study.table):
        with pytest.raises(graze.InputError):
            wrong("nowhere")
    from matplotlib import pyplot

    pyplot.close("all")


def test_queries_read_and_change_nothing(study):
    assert study.query("SELECT count(*) AS n FROM points_swept").n.tolist() == [11]
    assert study.query("SELECT label FROM special_points WHERE type = 'GR'").label == ["GR1"]
    for wrong in ("DELETE FROM points_swept", "SELECT", "ATTACH 'x' AS y", "SELECT * FROM nowhere", ""):
        with pytest.raises(graze.InputError):
            study.query(wrong)
    with pytest.raises(graze.InputError, match="points"):
        study["swept"].table("nowhere")


def test_results_are_read_while_another_process_writes_them(tmp_path):
    (tmp_path / "long.toml").write_text("""name = "long"
model = "impact-oscillator"
[runs.swept]
kind = "sweep"
vary = { omega = { from = 2.6, to = 2.9, points = 20000 } }
""")
    writer = subprocess.Popen([program(), "run", tmp_path / "long.toml", "--output", tmp_path / "out", "--quiet"])
    try:
        path, deadline = tmp_path / "out", time.monotonic() + 30
        results = counts = None
        while time.monotonic() < deadline and (counts is None or len(set(counts)) < 3):
            assert writer.poll() is None
            try:
                results = results or graze.read_results(path)
                run = results["swept"]
            except (graze.InputError, KeyError):  # it has not begun
                time.sleep(0.02)
                continue
            points = run.points
            counts = [*(counts or []), len(points)]
            assert run.status == "unfinished"
            assert points["number"].tolist() == sorted(points["number"].tolist())
            assert not numpy.isnan(points["omega"]).any() and None not in points["label"]
            time.sleep(0.05)
        assert counts == sorted(counts) and len(set(counts)) >= 3
        with pytest.raises(graze.FileError):  # there is one writer
            graze.run_study(tmp_path / "long.toml", output=path)
        with pytest.raises(graze.InputError):
            run.resume()
        copied = pickle.loads(pickle.dumps(run))
        assert len(copied.points) >= counts[-1]
    finally:
        writer.kill()
        writer.wait()
    assert len(results["swept"].points) >= counts[-1]


def test_an_interrupted_study_goes_on_to_the_same_bits(tmp_path):
    text = STUDY.replace("points = 11", "points = 61").replace("cycles = 80", "cycles = 80\nchaos_cycles = 100")
    whole = graze.run_study(text, output=tmp_path / "whole")
    with pytest.raises(graze.Interrupted) as told:
        graze.run_study(text, output=tmp_path / "broken", threads=1, progress=lambda state: state["all_done"] < 20)
    assert told.value.run["swept"].status == "unfinished"
    assert 20 <= len(told.value.run["swept"].points) < 61
    del told
    finished = graze.run_study(text, output=tmp_path / "broken")
    assert finished.reports[0]["computed"] < 61
    assert tables(finished) == tables(whole)


@pytest.mark.parametrize("by", ["program", "python"])
def test_a_killed_study_goes_on_to_the_same_bits(tmp_path, by):
    (tmp_path / "s.toml").write_text(STUDY.replace("points = 11", "points = 201").replace(
        "cycles = 80", "cycles = 80\nchaos_cycles = 100"))
    if by == "program":
        command = [program(), "run", tmp_path / "s.toml", "--output", tmp_path / "broken", "--quiet"]
    else:
        command = [sys.executable, "-c", "import graze, sys; graze.run_study(sys.argv[1], output=sys.argv[2])",
                   tmp_path / "s.toml", tmp_path / "broken"]
    writer = subprocess.Popen(command, env={**os.environ, "PYTHONPATH": os.path.dirname(os.path.dirname(graze.__file__))})
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline:
        try:
            if len(graze.read_results(tmp_path / "broken")["swept"].points) > 10:
                break
        except (graze.InputError, KeyError):
            pass
        time.sleep(0.01)
    writer.kill()
    writer.wait()
    only = ["swept"]
    finished = graze.run_study(tmp_path / "s.toml", output=tmp_path / "broken", only=only)
    whole = graze.run_study(tmp_path / "s.toml", only=only)
    assert finished["swept"].status == "complete"
    assert finished["swept"].points == whole["swept"].points and finished["swept"].samples == whole["swept"].samples


def test_files_of_older_formats_are_read_and_followed_further(study, tmp_path):
    path = tmp_path / "old.sqlite"
    study["impacting"].save(path)
    with sqlite3.connect(path) as file:
        for (view,) in file.execute("SELECT name FROM sqlite_master WHERE type = 'view'").fetchall():
            file.execute(f"DROP VIEW {view}")
        for name in ("free", "impacting", "rest"):
            file.execute(f"ALTER TABLE branch_{name} RENAME COLUMN touch_speed_factor TO touch_first_speed")
        file.execute("DROP TABLE half_multipliers")
        file.execute("PRAGMA user_version = 6")
    file.close()
    old = graze.read_results(path)
    assert old.format == 6 and "half_multipliers" in old.missing
    assert old["impacting"].points == study["impacting"].points
    assert old["impacting"]["PD1"].multipliers.tolist() == study["impacting"]["PD1"].multipliers.tolist()
    assert old["impacting"]["PD1"].double(steps=3).points == study["impacting"]["PD1"].double(steps=3).points
    with sqlite3.connect(path) as file:
        file.execute("PRAGMA user_version = 99")
        file.execute("DELETE FROM meta WHERE key = 'oldest reader'")
    file.close()
    with pytest.raises(graze.InputError, match="format 99"):
        graze.read_results(path)


def test_what_is_no_result_file_is_told(tmp_path):
    (tmp_path / "text").write_text("no database")
    sqlite3.connect(tmp_path / "other").execute("CREATE TABLE a (b)").connection.close()
    (tmp_path / "empty").write_text("")
    with pytest.raises(graze.FileError):
        graze.read_results(tmp_path / "nowhere")
    for name in ("text", "other", "empty"):
        with pytest.raises(graze.InputError):
            graze.read_results(tmp_path / name)


def test_runs_that_were_read_go_on_and_say_what_they_cannot(study, by_program, tmp_path):
    results = graze.read_results(by_program / "out")
    before = (by_program / "out" / "results.sqlite").read_bytes()
    doubled = results["impacting"]["PD1"].double(steps=5)
    assert doubled.points == study["impacting"]["PD1"].double(steps=5).points
    onward = graze.ensemble(results["swept"], at={"omega": 2.75}, periods=2)
    assert onward.points["omega"].tolist() == [2.75] if "omega" in onward.points else len(onward.points) == 1
    assert (by_program / "out" / "results.sqlite").read_bytes() == before
    for text in (results["impacting"].study, doubled.study, lambda: doubled.write_study(tmp_path)):
        with pytest.raises(graze.InputError, match="no text"):
            text()
    doubled.save(tmp_path / "all.sqlite")  # the file has all that is needed
    subprocess.run([program(), "run", tmp_path / "all.sqlite", "--output", tmp_path / "again", "--no-pictures", "--quiet"],
                   check=True)
    assert graze.read_results(tmp_path / "again")[doubled.name].points == doubled.points


def test_studies_are_pickled_with_their_results(study, tmp_path):
    again = pickle.loads(pickle.dumps(study))
    assert tables(again) == tables(study) and again.reports == study.reports
    assert again.tables == study.tables and again.table("points") == study.table("points")
    run = pickle.loads(pickle.dumps(study["swept"]))
    assert run.points == study["swept"].points


def test_a_run_that_fails_does_not_stop_the_others():
    text = STUDY.replace("along = { omega = [2.2, 4.5] }\ndirection", "along = { omega = [5, 6] }\ndirection")
    results = graze.run_study(text)
    status = {report["name"]: report["status"] for report in results.reports}
    assert status == {"swept": "complete", "rest": "complete", "free": "failed", "impacting": "skipped"}
    assert results["free"].status == "failed" and "bounds" in results["free"].failure


def test_places_that_cannot_be_written_are_told(study, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    below = tmp_path / "file" / "folder"
    run = graze.ensemble(graze.Model.shipped("impact-oscillator"), vary={"omega": [2.7]}, periods=1)
    for call in (lambda: graze.run_study(STUDY, output=below), lambda: study.write_tables(below),
                 lambda: study.write_pictures(below), lambda: run.write_study(below), lambda: run.save(below)):
        with pytest.raises(graze.FileError):
            call()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "nowhere"))
    with pytest.raises(graze.FileError):
        graze.run_study(STUDY)


def test_damaged_texts_are_told(study, tmp_path, monkeypatch):
    run = graze.follow(study["rest"], along={"omega": (3.9, 4.1)})
    run.save(tmp_path / "whole.sqlite")
    assert sorted(os.listdir(tmp_path)) == ["whole.sqlite", "whole.sqlite.lock"]
    contents = (tmp_path / "whole.sqlite").read_bytes()
    read = graze.read_results(tmp_path / "whole.sqlite")[run.name]
    with pytest.raises(KeyError):
        read["XX1"]
    place = contents.rindex(read.settings[:40].encode()) + 20
    (tmp_path / "damaged.sqlite").write_bytes(contents[:place] + b"\xff" + contents[place + 1:])
    with pytest.raises(graze.FileError, match="damaged.sqlite: the file is damaged"):
        graze.read_results(tmp_path / "damaged.sqlite")[run.name]

    def unreadable(*arguments, **keys):
        raise graze.FileError("the file is damaged", file="whole.sqlite")

    monkeypatch.setattr(read._store, "read", unreadable)
    for look in (lambda: read["EP1"], lambda: "EP1" in read):
        with pytest.raises(graze.FileError):  # and no KeyError
            look()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no device without room")
def test_a_full_device_is_told():
    with pytest.raises(graze.FileError, match="No space left"):
        graze.Model.shipped("impact-oscillator").save("/dev/full")
