import copy
import gc
import math
import pickle

import numpy
import pytest

import graze


@pytest.fixture
def table():
    return graze.Table(["x", "label", "n"], [numpy.array([1.0, math.nan, 3.0]), ["a", None, "<b>"], numpy.arange(3)],
                       ["mm", "", ""])


@pytest.fixture(scope="module")
def run():
    return graze.sweep(graze.Model.shipped("impact-oscillator"), vary={"omega": (2.7, 2.75, 6)}, cycles=80)


def test_a_table_is_a_mapping_and_has_its_columns_as_attributes(table):
    assert list(table) == ["x", "label", "n"] == list(table.keys()) == list(table.columns)
    assert table["x"] is table.x
    assert len(table) == 3
    assert "x" in table and "y" not in table and 3 not in table
    assert dict(table.items())["label"] == ["a", None, "<b>"]
    assert "label" in dir(table)
    with pytest.raises(KeyError, match="columns are x, label, n"):
        table["y"]
    with pytest.raises(AttributeError):
        table.y
    assert not graze.Table(["x"], [numpy.empty(0)])
    assert repr(table) == "<Table of 3 rows: x, label, n>"
    wide = graze.Table([f"c{i}" for i in range(40)], [numpy.zeros(1)] * 40)
    assert repr(wide).endswith("c10, and 29 more>") and repr(wide).startswith("<Table of 1 row: ")
    with pytest.raises(graze.InputError):
        graze.Table(["x", "y"], [numpy.zeros(1), numpy.zeros(2)])


def test_rows_are_chosen_by_truths_slices_and_indices(table):
    assert table[1:]["n"].tolist() == [1, 2]
    assert table[table.n > 0]["label"] == [None, "<b>"]
    assert table[[False, False, True]].x.tolist() == [3]
    assert table.rows([-1, 0]).label == ["<b>", "a"]
    assert len(table.rows([])) == 0
    assert table[1:].units == {"x": "mm"}
    for wrong in ([True], [7]):
        with pytest.raises(graze.InputError):
            table.rows(wrong)


def test_records_are_rows_of_plain_values(table):
    rows = list(table.records())
    assert rows[0] == {"x": 1.0, "label": "a", "n": 0} == table.record(0)
    assert math.isnan(rows[1]["x"]) and rows[1]["label"] is None
    assert [type(value) for value in rows[2].values()] == [float, str, int]
    with pytest.raises(IndexError):
        table.record(3)


def test_equality_takes_missing_numbers_as_equal(table):
    assert table == graze.Table(["x", "label", "n"], [numpy.array([1, math.nan, 3]), ["a", None, "<b>"], numpy.arange(3)],
                                ["mm", "", ""])
    assert table != table[:2]
    assert table != graze.Table(["x", "label", "n"], list(table.values()), ["m", "", ""])
    assert table != graze.Table(["x", "label", "n"], [table.x, table.label, table.n + 1], ["mm", "", ""])
    assert table != 3


def test_copies_pickles_and_arrays_have_the_same_values(table):
    for same in (copy.copy(table), copy.deepcopy(table), pickle.loads(pickle.dumps(table))):
        assert same == table
    array = table.array
    assert array.dtype.names == ("x", "label", "n")
    assert array["x"][2] == 3 and array["label"][1] is None and array["n"].dtype == table.n.dtype
    assert numpy.asarray(table).tolist()[0] == (1.0, "a", 0)


def test_notebooks_show_an_escaped_table(table):
    text = table._repr_html_()
    assert "&lt;b&gt;" in text and "<b>" not in text
    assert "<small>mm</small>" in text and "<p>3 rows</p>" in text
    assert "<td></td>" in text  # of missing values
    long = graze.Table(["<n>"], [numpy.arange(1000)])._repr_html_()
    assert long.count("<tr>") == 22 and "&lt;n&gt;" in long and "<td>999</td>" in long


def test_pandas_and_xarray_get_values_and_units(table):
    pandas = pytest.importorskip("pandas")
    frame = table.to_pandas()
    assert list(frame.columns) == ["x", "label", "n"] and frame.attrs["units"] == {"x": "mm"}
    assert frame["x"][2] == 3 and pandas.isna(frame["x"][1])
    xarray = pytest.importorskip("xarray")
    if not hasattr(xarray, "Dataset"):
        pytest.skip("no xarray")
    data = table.to_xarray()
    assert data["x"].attrs["units"] == "mm" and data["label"].values[2] == "<b>"


def test_columns_of_one_name_stay_apart(run):
    table = run.query(f"SELECT omega, omega, omega AS omega_2 FROM points_{run.name}")
    assert list(table) == ["omega", "omega_2", "omega_2_2"]
    assert table.omega.tolist() == table.omega_2.tolist() == table.omega_2_2.tolist()


def test_missing_numbers_are_nan_and_whole_numbers_stay_whole(run):
    assert run.points["number"].tolist() == [0, 1, 2, 3, 4, 5]
    assert run.points["number"].dtype == numpy.int64
    table = run.query("SELECT 1 AS whole UNION ALL SELECT NULL")
    assert table.whole[0] == 1 and math.isnan(table.whole[1])
    mixed = run.query("SELECT 1 AS cell UNION ALL SELECT 'a' UNION ALL SELECT NULL")
    assert mixed.cell == [1, "a", None]
    assert run.query("SELECT 1 AS none WHERE 0").none.tolist() == []


def test_a_column_lives_on_without_its_table_and_run():
    run = graze.sweep(graze.Model.shipped("impact-oscillator"), vary={"omega": (2.7, 2.75, 6)}, cycles=80)
    column = run.points["omega"]
    part = run.samples[5:]["omega"] if "omega" in run.samples else run.samples[5:]["v"]
    kept, kept_part = column.tolist(), part.tolist()
    del run
    gc.collect()
    junk = [numpy.full(1000, 7.0) for _ in range(200)]  # would take the place of freed memory
    assert column.tolist() == kept and part.tolist() == kept_part
    assert numpy.allclose(kept, numpy.linspace(2.7, 2.75, 6), rtol=1e-14)
    with pytest.raises(ValueError, match="read-only"):
        column[0] = 5.0
    assert len(junk) == 200


def test_columns_can_be_read_only_and_copies_can_be_changed(table):
    given = numpy.arange(3.0)
    columns = [graze.Table(["x"], [given])["x"], table["x"], table[1:]["x"], table[table.n > 0]["x"], table[[0]].x,
               pickle.loads(pickle.dumps(table)).x, copy.copy(table).x, copy.deepcopy(table).x]
    for column in columns:
        with pytest.raises(ValueError, match="read-only"):
            column -= 1
    given[0] = 7  # what a caller gave remains the caller's
    for free in (table.to_pandas()["x"].values, table.to_xarray()["x"].values, table.array, table.x.copy()):
        free[0] = free[1]
    assert table.x[0] == 1 and table.record(-1) == table.record(2)


@pytest.mark.parametrize("number, kind, words", [
    (None, TypeError, "number: None is no number of a row"), ("x", TypeError, "'x'"), (1.5, TypeError, "1.5"),
    (2**63, IndexError, "there are 3"), (3, IndexError, "there is no row 3"), (-4, IndexError, "there is no row -4")])
def test_rows_that_are_not_there(table, number, kind, words):
    with pytest.raises(kind, match=words):
        table.record(number)
