"""Models that are read, their values, and expressions."""

import copy
import csv
import fractions
import itertools
import math
import os
import pathlib
import pickle
import subprocess
import textwrap

import numpy
import pytest

import graze


def program():
    """The program `graze` of the same build, or that of the variable GRAZE."""
    beside = pathlib.Path(graze.__file__).parents[2] / "bin/graze"
    path = os.environ.get("GRAZE", beside if beside.exists() else None)
    if path is None:
        pytest.skip("the program graze is not built")
    return str(path)


# Models.


def test_a_shipped_model_has_parameters_with_units():
    model = graze.Model.shipped("impact-oscillator")
    assert "impact-oscillator" in graze.models()
    assert model.name == "impact-oscillator"
    model.parameters.omega = 2.8
    assert model.parameters["omega"] == 2.8
    assert set(model.parameters.units) == set(model.parameters)
    with pytest.raises(AttributeError):
        model.parameters.omeg
    with pytest.raises(graze.ModelError) as told:
        model.parameters["omeg"] = 1
    assert "omega" in told.value.remedy


def test_parameters_are_set_by_expressions_as_in_the_program(tmp_path):
    model = graze.Model.shipped("impact-oscillator", omega="2*pi/3", zeta=fractions.Fraction(1, 64))
    assert model.parameters.omega == 2 * math.pi / 3 and model.parameters.zeta == 1 / 64
    omega = graze.symbols("omega")
    model.parameters.sigma = 3 * omega / math.pi
    assert model.parameters.sigma == pytest.approx(2, rel=1e-15)
    model.parameters.sigma = numpy.float32(0.5)
    assert model.parameters.sigma == 0.5 and model.value("2*sigma + omega") == 1 + 2 * math.pi / 3
    assert model.value(2 * graze.symbols("sigma")) == 1 and model.value(3) == 3
    printed = subprocess.run([program(), "simulate", "impact-oscillator", "--set", "omega=2*pi/3", "zeta=1/64", "sigma=0.5",
                              "--time", "3", "--samples", "2", "--format", "csv"], check=True, capture_output=True,
                             text=True).stdout
    last = list(csv.DictReader(line for line in printed.splitlines() if not line.startswith("#")))[-1]
    motion = graze.simulate(model, time=3, samples=2)
    assert [float(last["x"]), float(last["v"])] == [motion["x"][-1], motion["v"][-1]]


def test_initial_values_are_a_mapping_and_attributes():
    model = graze.Model.shipped("bouncing-ball")
    assert list(model.initial) == [one.name for one in model.states]
    model.initial.v = -1
    model.initial["x"] = "g/2"
    assert model.initial == {"x": model.parameters.g / 2, "v": -1, "theta": 0}
    assert model.initial.v == -1 and len(model.initial) == 3 and "x" in model.initial and "y" not in model.initial
    assert model.initial.units == {"x": "m", "v": "m/s", "theta": "rad"} and all(model.initial.texts.values())
    assert {"x", "v", "units"} <= set(dir(model.initial))
    x = graze.symbols("x")
    assert model.initial[x] == model.initial.x and x in model.initial
    other = model.with_(v=2, g=1)
    assert (other.initial.v, other.parameters.g, model.initial.v) == (2, 1, -1)
    assert graze.simulate(other, time=0.01, samples=2)["v"][0] == 2


def test_the_initial_mode_can_be_set():
    model = graze.Model.shipped("mems-switch")
    assert model.initial_mode == "on"
    model.initial_mode = "off"
    assert graze.simulate(model, time=0.01, samples=2).end_mode == "off"
    assert 'mode = "off"' in str(model)


def test_names_of_all_parts_are_known():
    model = graze.Model.shipped("impact-oscillator-two-stops")
    assert set(model.modes) == {"free", "free-right", "free-left"}
    assert set(model.events) == {"right", "left", "free-right-right-opens", "free-left-left-opens"}
    assert set(model.jumps) == {"identity", "impact-right", "rest-right", "impact-left", "rest-left"}
    assert model.sections == ("phase0", "phasepi", "turning") and model.symmetries == ("reflection",)
    assert model.quantities == ("gap_right", "gap_left", "energy") and model.definitions == ("force",)
    assert model.transitions[0] == ("free:right", "free", "right", "impact-right")
    assert model.periods == {"theta": 2 * math.pi}
    assert model.states[0].text == "position"


def test_copies_do_not_change_one_another():
    model = graze.Model.shipped("mems-switch")
    again = graze.Model(text=str(model))
    assert str(again) == str(model)
    for make in (copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))):
        other = make(model)
        assert other == model
        name = model.parameters.independent[0]
        other.parameters[name] *= 2
        other.initial.q = 0.25
        assert other != model
        assert other.parameters[name] == 2 * model.parameters[name] and model.initial.q != 0.25
    assert copy.copy(model.parameters) == model.parameters
    assert model != str(model)


def test_a_model_is_saved_and_read(tmp_path):
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    path = tmp_path / "model.toml"
    model.save(path)
    assert path.read_text() == str(model)
    for again in (graze.Model(file=path), graze.load(path), graze.load(str(path)), graze.load(os.fsencode(path))):
        assert again == model
    assert graze.load(path, omega=3).parameters.omega == 3
    assert graze.Model(file=path, parameters={"omega": 3}, sigma=0.5) == model.with_(omega=3, sigma=0.5)
    checked = subprocess.run([program(), "check", str(path)], check=True, capture_output=True, text=True)
    assert checked.stderr == ""


def test_mistakes_have_places():
    with pytest.raises(graze.ModelError) as told:
        graze.Model(text='name = "x"\n[states.q]\ninitial = "1 +"\n')
    assert told.value.line > 0
    assert len(told.value.all) >= 1
    again = pickle.loads(pickle.dumps(told.value))
    assert str(again) == str(told.value)
    with pytest.raises(graze.InputError):
        graze.load("/nowhere/model.toml")


@pytest.mark.parametrize("name", sorted(graze.models()))
def test_a_model_is_described_and_checked_as_by_the_program(name):
    model = graze.Model.shipped(name)
    printed = subprocess.run([program(), "check", name], check=True, capture_output=True, text=True,
                             env={**os.environ, "COLUMNS": "100"})
    assert model.describe() == printed.stdout
    assert printed.stderr == "" and model.check() == ()
    table = subprocess.run([program(), "check", name, "--format", "csv"], check=True, capture_output=True, text=True)
    rows = [line for line in table.stdout.splitlines() if not line.startswith("#")]
    assert len(model.table()) == len(rows) - 1
    assert list(model.table()) == ["item", "name", "value", "unit", "text"]


def test_findings_are_those_of_the_program(tmp_path):
    text = textwrap.dedent("""\
        [parameters]
        unused = 1
        [states]
        x = -1
        v = 0
        [modes.motion]
        rates = { x = "v", v = "1" }
        watch = ["wall"]
        [modes.never]
        rates = { x = 0, v = "sqrt(x - 5)" }
        [events.wall]
        function = "x"
        [events.forgotten]
        function = "v"
        [jumps.none]
        v = 0
        [[transitions]]
        mode = "motion"
        event = "wall"
        next = [{ when = "v > 0", mode = "motion" }]
        [initial]
        mode = "motion"
        """)
    path = tmp_path / "model.toml"
    path.write_text(text)
    found = graze.Model(text=text).check()
    printed = subprocess.run([program(), "check", str(path)], check=True, capture_output=True, text=True).stderr
    warnings = [line.removeprefix(f"graze: warning: {path}") for line in printed.splitlines()]
    assert len(found) == len(warnings) >= 6
    for one, line in zip(found, warnings):
        assert line.endswith(": " + one.text) and isinstance(one, graze.Finding)
    assert graze.Finding("", "nothing uses the parameter 'unused'") in found
    assert any(one.part == "events.wall" for one in found)


def test_what_notebooks_show_is_escaped():
    x = graze.State("x", text="<script>x</script>", unit="<m>")
    k = graze.Parameter("k", 1, text="a & b", unit="\"N\"")
    model = graze.Model("<name>", text="<b>bold</b>", states=[x], parameters=[k], rates={x: -k*x})
    shown = model._repr_html_() + model.parameters._repr_html_() + model.initial._repr_html_()
    for raw in ("<script>", "<m>", "<name>", "<b>bold", "a & b", '"N"'):
        assert raw not in shown
    assert "&lt;script&gt;" in shown and "a &amp; b" in shown and "&lt;name&gt;" in shown
    assert repr(model.parameters) == '{k: 1 "N"}' and repr(model.initial) == "{x: 0 <m>}"
    assert repr(model) == "<Model <name>: states x>"
    assert "theta" in graze.Model.shipped("impact-oscillator")._repr_html_()


# Expressions.


def test_expressions_are_made_by_operators():
    x, v = graze.symbols("x v")
    assert str(x + 2 * v) == "x + 2*v" and str(2 * v + x) == "2*v + x"
    other = graze.symbols("k")
    assert set((other * x).symbols) == {"x", "k"}
    assert (x * x).derivative(x) == 2 * x
    assert graze.sin(0.5) == math.sin(0.5)
    assert str(graze.sin(x)) == "sin(x)"
    assert pickle.loads(pickle.dumps(x**2 + 2 * v)) == x**2 + 2 * v
    assert str((x > 0) & (v <= 1)) == "x > 0 and v <= 1"
    with pytest.raises(graze.InputError):
        bool(x > 0)


NAMES = ("a", "b", "c")
BINARY = {"+": lambda one, other: one + other, "-": lambda one, other: one - other,
          "*": lambda one, other: one * other, "/": lambda one, other: one / other,
          "**": lambda one, other: one**other}
UNARY = {"-": lambda one: -one, "sqrt": graze.sqrt, "exp": graze.exp, "log": graze.log, "sin": graze.sin,
         "cos": graze.cos, "tan": graze.tan, "asin": graze.asin, "acos": graze.acos, "atan": graze.atan,
         "sinh": graze.sinh, "cosh": graze.cosh, "tanh": graze.tanh, "erf": graze.erf}


def test_operators_and_functions_have_the_values_of_python():
    at = {"a": 0.7, "b": 0.3, "c": 1.9}
    symbols = dict(zip(NAMES, graze.symbols("a b c")))
    for function in UNARY.values():
        made = function(symbols["a"] * symbols["b"])
        assert float(made.substitute(at)) == pytest.approx(function(at["a"] * at["b"]), rel=1e-15)
    for operation, (one, other) in itertools.product(BINARY.values(), itertools.permutations([*NAMES, 2, 0.5], 2)):
        value = operation(at.get(one, one), at.get(other, other))
        made = operation(symbols.get(one, one), symbols.get(other, other))
        if isinstance(made, graze.Expression):
            made = float(made.substitute(at))
        assert made == pytest.approx(value, rel=1e-15)
    assert +symbols["a"] == symbols["a"]


def test_numpy_takes_expressions():
    x, v = graze.symbols("x v")
    for name in "sqrt exp log sin cos tan sinh cosh tanh".split():
        assert getattr(numpy, name)(x) == getattr(graze, name)(x)
    assert numpy.arcsin(x) == graze.asin(x) and numpy.arctan(x) == graze.atan(x) and numpy.arccos(x) == graze.acos(x)
    assert numpy.power(x, 3) == x**3 and numpy.square(x) == x * x and numpy.negative(x) == -x
    for number in (numpy.float64(2), numpy.float32(2), numpy.int64(2), numpy.array(2.0)):
        assert number * x == 2 * x and x * number == 2 * x and number - x == 2 - x and x**number == x**2
        assert (x > number) == (x > 2)
    assert (numpy.float64(2) < x) == (numpy.int64(2) < x) == (numpy.float32(2) < x) == (x > 2)
    assert list(numpy.array([1, 2]) * x) == list(x * numpy.array([1, 2])) == [x, 2 * x]
    assert numpy.dot(numpy.array([[1, 2], [0, 3]]), numpy.array([x, v])).tolist() == [x + 2 * v, 3 * v]
    assert sum([x, v, 1]) == x + v + 1
    assert graze.sin(numpy.array([0.5])) == pytest.approx([math.sin(0.5)], rel=1e-15)


def test_equal_expressions_are_equal_whatever_the_order_in_which_they_were_made():
    a, b, c = graze.symbols("a b c")
    d = graze.symbols("d")
    pairs = [(a + b, b + a), (a * b + c * d, d * c + b * a), ((a + b) * (c + d), (d + c) * (b + a)),
             (graze.sin(a * b) - c, -(c - graze.sin(b * a))), (a - b, -(b - a)),
             ((a * b) / (c + d), (b * a) / (d + c)), (a + a, 2 * a), (a**2, a**2.0)]
    for one, other in pairs:
        assert one == other and hash(one) == hash(other)
        assert pickle.loads(pickle.dumps(one)) == other
        assert str(pickle.loads(pickle.dumps(one))) == str(one)
    for one, other in [(a + b, a - b), (a - b, b - a), (a / b, b / a), (a**b, b**a), (a, b), (graze.sin(a), graze.cos(a)),
                       (a + b, a + c), (a * b, a + b), (2 * a, 3 * a)]:
        assert one != other
        assert hash(one) != hash(other)
    assert {a + b: 1}[b + a] == 1 and len({a * b, b * a, a}) == 2
    assert a != "a" and a != 1 and a is not None and a != None  # noqa: E711
    assert graze.expression("1/2") == 0.5 and hash(graze.expression("1/2")) == hash(0.5)
    assert graze.State("a", 3) == a and hash(graze.Parameter("a")) == hash(a)


def test_texts_and_numbers_become_expressions():
    x, v = graze.symbols("x v")
    assert graze.expression("v + x^2*sin(x)/1e5") == v + x**2 * graze.sin(x) / 1e5
    assert str(graze.expression("v + x")) == "v + x" and str(graze.expression("x + v")) == "x + v"
    assert graze.expression(3) == 3 and graze.expression(x) is x
    assert graze.expression("2*pi") == 2 * math.pi
    assert float(graze.expression("x*v").substitute({x: 3}, v=graze.expression(0.5))) == 1.5
    assert (x * v).substitute(x=v, v=x) == x * v and (x - v).substitute(x=v, v=x) == v - x
    assert (x**3 * v).derivative("x") == 3 * x**2 * v and (x * v).derivative(graze.State("v")) == x
    with pytest.raises(graze.InputError) as told:
        graze.expression("x*(v + ", "x", "v")
    assert (told.value.line, told.value.column) == (1, 6)


def test_long_sums_are_quick_and_forgotten_ones_take_no_memory():
    x, v = graze.states("x v")
    left, right = 0, 0
    for i in range(1, 3000):
        left = left + i * x**i
        right = i * x**i + right
    assert float(left.substitute(x=1)) == float(right.substitute(x=1)) == 3000 * 2999 / 2
    base = x**2 + v
    small = len(pickle.dumps(base))
    made = [base * i + x for i in range(1000)]
    assert made[5] == x + 5 * (v + x**2) and len(pickle.dumps(base)) == small


WRONG = {
    "abs": (lambda x: abs(x), "'abs' is not analytic"),
    "%": (lambda x: x % 2, "'mod' is not analytic"),
    "% of a number": (lambda x: 2 % x, "'mod' is not analytic"),
    "//": (lambda x: x // 2, "'floor' is not analytic"),
    "round": (lambda x: round(x), "'round' is not analytic"),
    "math.floor": (lambda x: math.floor(x), "'floor' is not analytic"),
    "divmod": (lambda x: divmod(x, 2), "'mod' is not analytic"),
    "numpy.floor": (lambda x: numpy.floor(x), "'floor' is not analytic"),
    "numpy.arctan2": (lambda x: numpy.arctan2(x, 1), "'atan2' is not analytic"),
    "numpy.log10": (lambda x: numpy.log10(x), "write log(x)/log(10)"),
    "numpy.hypot": (lambda x: numpy.hypot(x, x), "write sqrt(a^2 + b^2)"),
    "numpy.arcsinh": (lambda x: numpy.arcsinh(x), "write log(x + sqrt(x^2 + 1))"),
    "numpy.sign": (lambda x: numpy.sign(x), "neither true nor false"),
    "math.sin": (lambda x: math.sin(x), "depends on x; functions of expressions are graze.sin"),
    "float": (lambda x: float(2 * x), "2*x is no number: it depends on x"),
    "float of 1/0": (lambda x: float(x.substitute(x=1) / 0), "has no finite value"),
    "^": (lambda x: x ^ 2, "write **"),
    "max": (lambda x: max(x, 1), "neither true nor false"),
    "if": (lambda x: 1 if x > 0 else 2, "neither true nor false"),
    "two comparisons": (lambda x: 0 < x < 1, "join conditions by &"),
    "and": (lambda x: x > 0 and x < 1, "join conditions by &"),
    "|": (lambda x: (x > 0) | (x < -1), "cannot be joined by `|`"),
    "~": (lambda x: ~(x > 0), "cannot be negated"),
    "NaN": (lambda x: x * math.nan, "must be finite"),
    "infinity": (lambda x: x > math.inf, "must be finite"),
    "a product without sign": (lambda x: graze.expression("2x"), "write 2*x"),
    "an unknown name": (lambda x: graze.expression("x + y", "x"), "unknown name 'y'"),
    "an unknown function": (lambda x: graze.expression("foo(x)"), "foo"),
    "a reserved name": (lambda x: graze.expression("t + x"), "'t' is a reserved name"),
    "no text": (lambda x: graze.expression(None), "None is no expression"),
    "a truth": (lambda x: graze.expression(True), "True is no expression"),
    "half a character": (lambda x: graze.expression("\ud800"), "no characters"),
    "no names": (lambda x: graze.symbols(" "), "no names are given"),
    "a name of signs": (lambda x: graze.symbols("x+"), "'x+' cannot be a name"),
    "a number as name": (lambda x: graze.Expression(3), "3 cannot be a name"),
    "a derivative by a product": (lambda x: x.derivative(2 * x), "'2*x' is no symbol"),
    "a product replaced": (lambda x: x.substitute({2 * x: 1}), "2*x is no symbol"),
    "no dict": (lambda x: x.substitute(3), "3 is no dict"),
    "a function outside its domain": (lambda x: graze.sqrt(-1), "sqrt(-1) is no number"),
    "a function of a text": (lambda x: graze.sin("x"), "sin('x') is no number"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_what_expressions_cannot_be_is_told(wrong):
    call, words = WRONG[wrong]
    with pytest.raises(graze.InputError) as told:
        call(graze.symbols("x"))
    assert words in str(told.value)


@pytest.mark.parametrize("call", [lambda x: x + "a", lambda x: x + 1j, lambda x: x + None, lambda x: x @ x, lambda x: x < "a",
                                  lambda x: pow(x, 2, 3), lambda x: len(x), lambda x: x[0], lambda x: x(),
                                  lambda x: (x > 0) & x, lambda x: graze.Expression(), lambda x: type(x).__new__(type(x)),
                                  lambda x: graze.State.__new__(graze.State), lambda x: x.substitute(1, 2)])
def test_what_python_refuses_is_a_type_error(call):
    with pytest.raises(TypeError):
        call(graze.symbols("x"))
