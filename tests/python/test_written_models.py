"""Models written in Python."""

import copy
import doctest
import math
import pathlib
import pickle
import random
import re
import sys
import tomllib

import numpy
import pytest

import graze


# Every shipped model, taken apart and written again.


def as_text(value):
    return value


def as_expression(value):
    return value if isinstance(value, (int, float)) else graze.expression(value)


def by_operators(names):
    functions = {name: getattr(graze, name) for name in
                 "sqrt exp log sin cos tan asin acos atan sinh cosh tanh erf".split()}
    known = {**functions, "pi": math.pi, **{name: graze.symbols(name) for name in names}}

    def made(value):
        return value if isinstance(value, (int, float)) else eval(value.replace("^", "**"), {"__builtins__": {}}, known)

    return made


def fields_of(item, first):
    return dict(item) if isinstance(item, dict) else {first: item}


def written(data, made):
    """A model of the data of a model file."""
    def mapped(entries):
        return {name: made(value) for name, value in entries.items() if name != "text"}

    parts = {key: data[key] for key in ("name", "text", "source", "time_unit") if key in data}
    parts["initial_mode"] = data.get("initial", {}).get("mode")
    parts["parameters"] = []
    for name, item in data.get("parameters", {}).items():
        fields = fields_of(item, "value")
        parts["parameters"].append(graze.Parameter(name, made(fields.pop("value")), **fields))
    parts["states"] = []
    for name, item in data["states"].items():
        fields = fields_of(item, "initial")
        for key in {"initial", "period"} & set(fields):
            fields[key] = made(fields[key])
        parts["states"].append(graze.State(name, **fields))
    parts["definitions"] = []
    for name, item in data.get("definitions", {}).items():
        fields = fields_of(item, "value")
        parts["definitions"].append(graze.Definition(name, made(fields.pop("value")), **fields))
    parts["modes"] = {name: graze.Mode(mapped(item["rates"]), watch=item.get("watch", []), text=item.get("text", ""))
                      for name, item in data["modes"].items()}
    parts["events"] = {}
    for name, item in data.get("events", {}).items():
        fields = fields_of(item, "function")
        parts["events"][name] = graze.Event(made(fields.pop("function")), **fields)
    parts["jumps"] = {name: graze.Jump(mapped(item), text=item.get("text", ""))
                      for name, item in data.get("jumps", {}).items()}
    parts["transitions"] = [graze.Transition(**item) for item in data.get("transitions", [])]
    parts["slides"] = {name: graze.Slide(**item) for name, item in data.get("slides", {}).items()}
    parts["friction"] = {name: graze.Friction(**mapped_but_text(item, made))
                         for name, item in data.get("friction", {}).items()}
    if "contacts" in data:
        parts["contacts"] = contacts_of(data["contacts"], made)
    parts["sections"] = {}
    for name, item in data.get("sections", {}).items():
        fields = {key: made(value) if key in ("function", "value") else value for key, value in item.items()}
        parts["sections"][name] = graze.Section(**fields)
    parts["symmetries"] = {name: graze.Symmetry(mapped(item.get("map", {})), modes=item.get("modes"),
                                                text=item.get("text", ""))
                           for name, item in data.get("symmetries", {}).items()}
    parts["quantities"] = {}
    for name, item in data.get("quantities", {}).items():
        fields = fields_of(item, "value")
        parts["quantities"][name] = graze.Quantity(made(fields.pop("value")), **fields)
    parts["conserved"] = {}
    for name, item in data.get("conserved", {}).items():
        fields = fields_of(item, "value")
        fields["modes"] = {mode: made(own) for mode, own in fields.get("modes", {}).items()} or None
        parts["conserved"][name] = graze.Conserved(made(fields.pop("value")) if "value" in fields else None, **fields)
    if "drawing" in data:
        parts["drawing"] = drawn(data["drawing"], made)
    return graze.Model(**parts)


def mapped_but_text(item, made):
    return {key: value if key == "text" else made(value) for key, value in item.items()}


def contacts_of(data, made):
    mass = [[made(one) for one in row] if isinstance(row, list) else made(row) for row in data["mass"]]
    settings = {key: data[key] for key in ("law", "modes") if key in data}
    each = {name: graze.Contact(**mapped_but_text(item, made)) for name, item in data.items() if isinstance(item, dict)}
    return graze.Contacts(each, mass, velocities=data["velocities"], **settings)


def drawn(data, made):
    def pair(value):
        return tuple(pair(one) if isinstance(one, list) else made(one) for one in value)

    def shape(data):
        return {key: pair(value) if isinstance(value, list) and key != "modes"
                else made(value) if key == "radius" else value for key, value in data.items()}

    return {"text": data["text"], "x": pair(data["x"]), "y": pair(data["y"]),
            "shapes": [shape(one) for one in data["shapes"]]}


def assert_same_data(one, other, names, path=""):
    """The data of two model files are the same; expressions that are written otherwise have the same values."""
    assert type(one) is type(other), path
    if isinstance(one, dict):
        assert list(one) == list(other), path
        for key in one:
            assert_same_data(one[key], other[key], names, f"{path}.{key}")
    elif isinstance(one, list):
        assert len(one) == len(other), path
        for number, pair in enumerate(zip(one, other)):
            assert_same_data(*pair, names, f"{path}[{number}]")
    elif isinstance(one, str) and one != other:
        draw = random.Random(1)
        for _ in range(5):
            at = {name: draw.uniform(0.1, 0.9) for name in names}
            values = [float(graze.expression(text, *names).substitute(at)) for text in (one, other)]
            assert values[0] == pytest.approx(values[1], rel=1e-12), path
    else:
        assert one == other, path


@pytest.mark.parametrize("name", sorted(graze.models()))
@pytest.mark.parametrize("how", ["text", "expression", "operators"])
def test_a_shipped_model_is_the_same_when_written_again(name, how):
    model = graze.Model.shipped(name)
    data = tomllib.loads(str(model))
    names = [*data.get("parameters", {}), *data["states"], *data.get("definitions", {}), *data.get("friction", {})]
    made = {"text": as_text, "expression": as_expression, "operators": by_operators(names)}[how]
    again = written(data, made)
    if how == "operators":  # in Python -a/b is (-a)/b, in model files -(a/b)
        assert_same_data(tomllib.loads(str(again)), data, names)
    else:
        assert str(again) == str(model)
        assert again == model


def example_of_the_format():
    page = (pathlib.Path(__file__).parents[2] / "docs/model-format.md").read_text(encoding="utf-8")
    return re.search(r"```toml file=ball-on-table.toml\n(.*?)```", page, re.DOTALL)[1]


def test_the_example_of_the_format_can_be_said():
    a, f, g, e, belt = graze.symbols("a f g e belt")
    x = graze.State("x", 2*a, unit="m", text="height")
    v = graze.State("v")
    theta = graze.State("theta", period="2*pi")
    s = graze.State("s", drifting=True)
    omega = graze.Parameter("omega", 2*math.pi*f, text="a string is an expression: this parameter depends on others")
    table = graze.Definition("table", a*graze.sin(theta))
    velocity = graze.Definition("table_velocity", a*omega*numpy.cos(theta))
    acceleration = graze.Definition("table_acceleration", -a*omega**2*numpy.sin(theta))
    gap = graze.Definition("gap", x - table, text="distance between ball and table")
    model = graze.Model(
        "ball-on-table",
        text="A ball bounces on a vibrating table. The first sentence is the summary in lists of models.",
        source="where the model comes from",
        time_unit="s",
        parameters={g: {"value": 9.81, "unit": "m/s^2", "text": "gravity"}, e: 0.8, a: 0.01,
                    f: graze.Parameter("f", 3, unit="Hz", text="frequency of the table"), omega: omega, "belt": 0.2},
        states=[x, v, theta, s],
        definitions=[gap, table, velocity, acceleration],
        modes={"flight": graze.Mode({x: v, v: -g, theta: omega, s: belt}, watch=["contact", "top"],
                                    text="the ball flies"),
               "rest": graze.Mode({x: velocity, v: acceleration, theta: omega, s: belt},
                                  text="the table carries the ball")},
        events={"contact": gap, "top": graze.Event(v, kind="section"), "release": g + acceleration},
        jumps={"impact": {v: velocity - e*(v - velocity)}, "land": {x: table, v: velocity}},
        transitions=[
            graze.Transition("contact", mode="flight", label="J1", jump="impact", chatter=("land", "rest")),
            graze.Transition("top", mode="flight", next=[(x > 100*a, "end"), "flight"]),
            graze.Transition("release", mode="rest", next="flight"),
        ],
        sections={"phase0": graze.Section(state=theta, value=0), "highest": graze.Section(v, direction="falling")},
        quantities={"energy": graze.Quantity(v**2/2 + g*x, unit="J/kg", text="energy of the ball per mass")},
        drawing={"text": "a ball on a vibrating table", "x": (-0.06, 0.06), "y": [-3*a, 0.08], "shapes": [
            {"kind": "line", "from": (-0.04, table), "to": (0.04, table)},
            {"kind": "circle", "at": [0, x + 0.004], "radius": 0.004, "colour": "blue"},
            {"kind": "text", "at": (0, -0.025), "text": "at rest", "modes": ["rest"]}]},
    )
    assert str(model) == str(graze.Model(text=example_of_the_format()))
    assert model.check() == ()


# What may be left out.


def ball(**changed):
    x, v = graze.states(x=1, v=0)
    g, e = graze.parameters(g=9.81, e=0.8)
    given = {"parameters": [g, e], "rates": {x: v, v: -g}, "events": {"contact": x},
             "transitions": [graze.Transition("contact", jump={v: -e*v})], **changed}
    return graze.Model("ball", **given)


def test_a_bouncing_ball_needs_few_lines_and_bounces():
    model = ball()
    assert (model.name, model.modes, model.events, model.jumps) == (
        "ball", ("motion",), ("contact",), ("identity", "contact"))
    assert model.transitions == (("motion:contact", "motion", "contact", "contact"),)
    assert dict(model.initial) == {"x": 1, "v": 0}
    times = graze.simulate(model, contacts=5, samples=0).contacts["time"]
    fall = math.sqrt(2 / 9.81)
    # After contact n the ball flies for 2 e^n of the time of its fall.
    expected, at = [], fall
    for n in range(1, 6):
        expected.append(at)
        at += 2 * fall * 0.8**n
    assert times == pytest.approx(expected, rel=1e-11)


def test_a_smooth_model_is_its_rates():
    x, v = graze.states(x=1, v=0)
    motion = graze.simulate(graze.Model(rates={x: v, v: -x}), time=3, samples=7)
    assert motion["x"] == pytest.approx(numpy.cos(motion.t), abs=1e-11)
    texts = graze.Model(rates={"x": "v", "v": "-x"}, states={"x": 1, "v": 0})
    assert texts == graze.Model(rates={x: v, v: -x})
    assert graze.Model(rates={"x": "v", "v": "-x"}).initial == {"x": 0, "v": 0}
    assert str(texts).startswith('name = "model"')


def test_parts_are_given_in_several_forms():
    x, v = graze.states("x v")
    model = ball()
    g, e = graze.symbols("g e")
    assert ball(parameters={g: 9.81, "e": 0.8}) == model
    assert ball(parameters={"g": {"value": "981/100"}, "e": numpy.float64(0.8)}) == model
    assert ball(states={x: 1, "v": {"initial": 0}}) == model
    assert ball(states=[graze.State("x", 1), v]) == model
    assert ball(events={"contact": {"function": "x"}}, watch="contact") == model
    assert ball(transitions=[{"event": "contact", "jump": {"v": "-e*v"}}]) == model
    assert ball(transitions=graze.Transition("contact", jump=graze.Jump({v: -e*v}), next="motion")) == model
    assert ball(transitions=[graze.Transition("contact", jump={v: -v*e}, next=["motion"], mode="motion")],
                initial_mode="motion") == model
    impact = graze.Jump({v: -e*v}, text="Newton")
    named = ball(jumps={"impact": impact}, transitions=[graze.Transition("contact", jump=impact)])
    assert named == ball(jumps={"impact": impact}, transitions=[graze.Transition("contact", jump="impact")])
    assert named.jumps == ("identity", "impact")
    several = graze.Model(modes={"a": {x: v, v: -g}, "b": {"rates": {x: 0, v: 0}, "text": "rest"}},
                          parameters=[graze.Parameter("g", 1)])
    assert several.modes == ("a", "b") and several.initial_mode == "a"
    assert ball(sections={"top": v}, symmetries={"same": {x: x}}, quantities={"height": x}).symmetries == ("same",)


def test_a_dependent_parameter_follows():
    f = graze.Parameter("f", 50, unit="Hz")
    omega = graze.Parameter("omega", 2*math.pi*f, unit="rad/s")
    k = graze.Parameter("k", omega)  # the same as another one
    model = graze.Model(rates={"x": omega*k}, parameters=[omega, f, k])
    assert model.parameters.independent == ("f",)
    model.parameters.f = 1
    assert model.parameters.omega == model.parameters.k == 2*math.pi
    assert model.parameters.units == {"omega": "rad/s", "f": "Hz", "k": ""}
    assert model.parameters.expressions == {"omega": "6.283185307179586*f", "k": "omega"}
    again = graze.Model(rates={"x": omega*k}, parameters={"k": omega, f: 3, omega: omega})
    assert again.parameters == {"k": 6*math.pi, "f": 3, "omega": 6*math.pi}


def test_events_are_watched_in_the_order_of_their_transitions():
    x, v = graze.states("x v")
    model = graze.Model(modes={"a": {x: v, v: 0}, "b": {x: v, v: 0}}, events={"one": x + 1, "two": 1 - x},
                        transitions=[graze.Transition(event, mode=mode, next="end")
                                     for mode, event in [("b", "two"), ("a", "two"), ("b", "one"), ("a", "one")]])
    data = tomllib.loads(str(model))
    assert [data["modes"][mode]["watch"] for mode in "ab"] == [["two", "one"], ["two", "one"]]
    assert [one["next"] for one in data["transitions"]] == ["end"] * 4


def test_jumps_of_transitions_have_names_of_their_own():
    x, v = graze.states("x v")
    model = graze.Model(modes={"a": {x: v, v: -1}, "b": {x: v, v: 1}, "c": {x: 0, v: 0}},
                        events={"wall": x + 1}, jumps={"wall": {v: 0}},
                        transitions=[graze.Transition("wall", mode="a", jump={v: -v}, chatter=({x: -1, v: 0}, "c")),
                                     graze.Transition("wall", mode="b", jump={v: -v}, chatter={"mode": "c"}),
                                     graze.Transition("wall", mode="c", jump="wall", chatter="c")])
    assert model.jumps == ("identity", "wall", "wall-2", "wall-3")
    data = tomllib.loads(str(model))
    assert data["jumps"] == {"wall": {"v": 0}, "wall-2": {"v": "-v"}, "wall-3": {"x": -1, "v": 0}}
    assert [one["jump"] for one in data["transitions"]] == ["wall-2", "wall-2", "wall"]
    assert data["transitions"][0]["chatter"] == {"jump": "wall-3", "mode": "c"}


def test_guards_are_comparisons():
    x, v = graze.states("x v")
    g = graze.parameters(g=1)
    model = graze.Model(
        modes={"a": {x: v, v: -g}, "b": {x: 0, v: 0}}, parameters=g, events={"wall": x},
        transitions=[graze.Transition("wall", mode="a", jump={v: -v}, next=[
            ((v > 1) & (x <= 2*g), "a"), (0 < v, "b"), ("v >= -1", "b"), {"when": v < numpy.int64(3), "mode": "end"},
            {"mode": "a"}])])
    assert tomllib.loads(str(model))["transitions"][0]["next"] == [
        {"when": "v > 1 and x <= 2*g", "mode": "a"}, {"when": "v > 0", "mode": "b"}, {"when": "v >= -1", "mode": "b"},
        {"when": "v < 3", "mode": "end"}, {"mode": "a"}]


def test_a_slide_and_a_friction_make_their_modes():
    x, v = graze.states(x=1, v=1)
    relay = graze.Model("relay", modes={"pull": graze.Mode({x: v, v: 1}), "push": graze.Mode({x: v, v: -1})},
                        events={"line": v + x/2}, initial_mode="push",
                        slides={"along": graze.Slide("line", ["pull", "push"], text="on the line")})
    assert relay.modes == ("pull", "push", "along")
    assert graze.Model(text=str(relay)) == relay and tomllib.loads(str(relay))["slides"]["along"]["between"] == ["pull", "push"]
    motion = graze.simulate(relay, time=30)
    met = math.sqrt(7) - 1
    assert abs(motion.end_state["x"] / ((1 + met - met**2/2)*math.exp(-(30 - met)/2)) - 1) < 1e-9
    rub, mu = graze.symbols("rub"), graze.Parameter("mu", 0.3)
    block = graze.Model("block", parameters=[mu], states={x: 0, v: 2}, rates={x: v, v: -rub/2},
                        friction={"rub": graze.Friction(v, 4, mu, static="2*mu")})
    assert block.modes == ("motion-backward", "motion-stick", "motion-forward") and block.initial_mode == "motion-forward"
    assert graze.Model(text=str(block)) == block
    assert abs(graze.simulate(block, time=9).end_state["x"] - 2**2/(2*0.6)) < 1e-12


def test_contacts_make_their_modes():
    x, v, y, w = graze.states(x=2, v=-1, y=0.5, w=0)
    floor = graze.Contact(y, 0.6, friction=0.2, slip=v, text="the ground")
    ball = graze.Model("ball", rates={x: v, v: 0, y: w, w: -9.81},
                       contacts=graze.Contacts({"floor": floor, "wall": graze.Contact(x, 0.8)}, mass={v: 1, w: 1}))
    assert "motion-floor-stick-wall" in ball.modes and graze.Model(text=str(ball)) == ball
    assert tomllib.loads(str(ball))["contacts"]["velocities"] == ["v", "w"]
    end = graze.simulate(ball, time=30)
    assert end.end_state["y"] == 0 and end.end_state["v"] == 0
    rows = graze.Model("ball", rates={x: v, v: 0, y: w, w: -9.81},
                       contacts=graze.Contacts({"floor": {"gap": y, "restitution": 0.6}}, mass=[[2, 1], [1, 2]],
                                               velocities=[v, w], law="poisson"))
    assert tomllib.loads(str(rows))["contacts"]["mass"] == [[2, 1], [1, 2]]


def test_the_texts_of_models_are_kept():
    said = 'two lines\n"quoted" \\ and é'
    model = ball(text=said, source="a book", time_unit="ms")
    assert (model.text, model.source, model.time_unit) == (said, "a book", "ms")
    assert graze.Model(text=str(model)) == model


def test_parts_are_copied_and_pickled():
    x, v = graze.states("x v")
    parts = [graze.State("q", x + v, unit="m", text="t", period=1, drifting=False), graze.Parameter("k", 2, unit="N/m"),
             graze.Definition("d", x*v, text="d"), graze.Mode({x: v}, watch=["a"]), graze.Event(x, kind="section"),
             graze.Jump({v: -v}), graze.Transition("a", next=[(x > v, "b")]), graze.Section(state=x, value=0),
             graze.Symmetry({x: -x}), graze.Quantity(x*v, unit="m"), graze.Slide("a", ["m", "n"], watch=[]),
             graze.Friction(v, 1, 0.3, static=0.4), graze.Contact(x, 0.5, friction=0.3, slip=v),
             graze.Contacts({"wall": graze.Contact(x, 0.5)}, mass={v: 1}), x > v]
    for part in parts:
        for again in (pickle.loads(pickle.dumps(part)), copy.copy(part), copy.deepcopy(part)):
            assert type(again) is type(part)
            assert again == part and repr(again) == repr(part)
            assert getattr(again, "__dict__", None) == getattr(part, "__dict__", None)
    assert graze.Event(x) != graze.Event(v) and graze.Event(x) != graze.Quantity(x)
    assert repr(graze.Event(x, text="wall")) == "Event(function=x, kind='barrier', text='wall')"


# Mistakes.

T = graze.Transition
x, v, theta = *graze.states(x=1, v=0), graze.State("theta", period="2*pi")
g, e = graze.parameters(g=9.81, e=0.8)


def switched(**changed):
    given = {"parameters": [g, e], "events": {"contact": x},
             "modes": {"flight": graze.Mode({x: v, v: -g}), "rest": graze.Mode({x: 0, v: 0})},
             "transitions": [T("contact", mode="flight", jump={v: -e*v}, chatter="rest")], **changed}
    return graze.Model("ball", **given)


def next_is(alternatives):
    return switched(transitions=[T("contact", mode="flight", next=alternatives)])


# What is done, and the words of the ModelError that it raises.
WRONG = {
    "Model()": (lambda: graze.Model(), "made of one text, of one file, or of its equations"),
    "only a name": (lambda: graze.Model("mems-switch"), "graze.load(name)"),
    "no rates": (lambda: graze.Model(rates={}), "has no states; give at least one state, with its initial value, in states="),
    "rates in a list": (lambda: graze.Model(rates=[1]), "rates: [1] is no dict"),
    "rates and modes": (lambda: ball(modes={}), "contradict each other"),
    "rates and a file": (lambda: ball(file="x.toml"), "read from a file or written by its equations"),
    "a parameter is missing": (lambda: ball(parameters=[g]), "Model(), transitions[0].jump['v']: unknown name 'e'"),
    "a name is misspelt": (lambda: ball(rates={x: v, v: "-gg*x"}),
                           "Model(), rates['v'], character 2: unknown name 'gg'; did you mean 'g'?"),
    "a text is cut": (lambda: ball(rates={x: "v +", v: -g}), "Model(), rates['x'], character 3: there is nothing to the"),
    "a rate is missing": (lambda: ball(states=[x, v], rates={x: v}),
                          "Model(), rates: the model has no rate for the state 'v'"),
    "a rate of no state": (lambda: ball(states=[x, v], rates={x: v, v: -g, "w": 1}), "rates['w']: there is no state 'w'"),
    "a parameter without value": (lambda: ball(parameters=[g, graze.Parameter("e")]), "'e' has no value; give it, as in"),
    "a parameter twice": (lambda: ball(parameters=[g, g, e]), "'g' is given twice"),
    "a state twice": (lambda: ball(states=[x, v, x]), "Model(), states: 'x' is given twice"),
    "a rate twice": (lambda: ball(rates={x: v, "x": v, v: -g}), "'x' is given twice"),
    "a text among parameters": (lambda: ball(parameters=[g, e, "k"]), "'k' is no graze.Parameter"),
    "a text of parameters": (lambda: ball(parameters="g e"), "'g e' is no list"),
    "a state among parameters": (lambda: ball(parameters=[g, e, x]), "x is no graze.Parameter"),
    "an unknown field": (lambda: ball(parameters={g: 9.81, "e": {"valu": 3}}), "did you mean 'value'?"),
    "parameters in a circle": (lambda: ball(parameters={"g": "e", "e": "g"}), "circle: g -> e -> g; define one"),
    "NaN": (lambda: ball(parameters={"g": math.nan, "e": 1}), "parameters['g']: parameters.g.value is nan"),
    "an infinite value": (lambda: ball(parameters={"g": 1, "e": "1/0"}), "parameters['e']: parameters.e.value is inf"),
    "a list as value": (lambda: ball(parameters={"g": [1], "e": 1}), "[1] is neither a number nor an expression"),
    "an array as value": (lambda: ball(parameters={"g": numpy.ones(2), "e": 1}), "is neither a number nor an expression"),
    "None as value": (lambda: ball(parameters={"g": None, "e": 1}), "the parameter 'g' has no value"),
    "True as value": (lambda: ball(parameters={"g": True, "e": 1}), "True is neither a number"),
    "a complex value": (lambda: ball(parameters={"g": 1j, "e": 1}), "1j is neither a number"),
    "a huge value": (lambda: ball(parameters={"g": 10**400, "e": 1}), "is no number of double precision"),
    "a condition as value": (lambda: ball(parameters={"g": x > 0, "e": 1}), "the condition x > 0 stands where"),
    "a name for two": (lambda: ball(parameters={"g": 1, "e": 1, "x": 1}), "the name 'x' is used twice"),
    "a reserved name": (lambda: graze.State("t"), "'t' is a reserved name"),
    "a name of two words": (lambda: graze.Parameter("a b"), "'a b' cannot be a name"),
    "a number as name": (lambda: graze.State(3), "3 cannot be a name"),
    "half a character": (lambda: ball(text="\ud800"), "text: there are parts of characters"),
    "half a character in a name": (lambda: graze.Definition("\ud800", 1), "parts of characters"),
    "a negative period": (lambda: ball(states={x: {"initial": 1, "period": -1}, v: 0}),
                          "Model(), states['x'].period: the period of 'x' is -1"),
    "cyclic and drifting": (lambda: ball(states=[graze.State("x", period=1, drifting=True), v]), "both cyclic and drifting"),
    "drifting in words": (lambda: ball(states={x: {"drifting": "yes"}, v: 0}), "'yes' is neither True nor False"),
    "a number as unit": (lambda: ball(states={x: {"unit": 3}, v: 0}), "states['x'].unit: 3 is no text"),
    "an initial value in states": (lambda: ball(states={x: 1, v: x}), "states['v']: states.v.initial uses the state 'x'"),
    "an initial value that is none": (lambda: ball(states={x: "log(0)", v: 0}), "Model(), states['x']: states.x.initial is -inf"),
    "definitions in a circle": (lambda: ball(definitions={"a": "b", "b": "a"}), "circle: a -> b -> a"),
    "states as definitions": (lambda: ball(definitions=[x]), "x is no graze.Definition"),
    "a barrier without transition": (lambda: ball(transitions=[], watch=["contact"]), 'add graze.Transition("contact"),'),
    "the same with modes": (lambda: switched(transitions=[], modes={"a": graze.Mode({x: v, v: 0}, watch=["contact"])}),
                            'modes[\'a\'].watch[0]: mode \'a\' watches the barrier \'contact\' but has no transition for it;'
                            ' add graze.Transition("contact", mode="a")'),
    "two transitions": (lambda: ball(transitions=[T("contact"), T("contact")]),
                        "transitions[1]: there is a second transition for event 'contact' in the model; write one with"),
    "a drawing in a list": (lambda: ball(drawing=[1]), "drawing: [1] is no dict; give a dict, as in"),
    "a drawing without limits": (lambda: ball(drawing={"x": (0, 1), "shapes": []}), "the drawing has no limits in y"),
    "a shape without kind": (lambda: ball(drawing={"x": (0, 1), "y": (0, 1), "shapes": [{"at": (x, 0)}]}),
                             "drawing['shapes'][0]: drawing['shapes'][0] has no kind"),
    "a shape of an unknown name": (
        lambda: ball(drawing={"x": (0, 1), "y": (0, 1), "shapes": [{"kind": "circle", "at": ("y", 0), "radius": 1}]}),
        "drawing['shapes'][0]['at']: unknown name 'y'"),
    "a colour that is a number": (lambda: ball(drawing={"shapes": [{"kind": "circle", "colour": 3}]}),
                                  "drawing['shapes'][0]['colour']: it is no text"),
    "limits that are no numbers": (lambda: ball(drawing={"x": (0, None)}), "drawing['x']: None is neither a number"),
    "an unknown event": (lambda: ball(transitions=[T("contakt")]), "transitions[0].event: there is no event 'contakt'"),
    "events in a list": (lambda: ball(events=["contact"]), "is no dict; give a dict from names to functions"),
    "an unknown kind": (lambda: ball(events={"contact": graze.Event(x, kind="wall")}), "events['contact'].kind: "),
    "an event that is None": (lambda: ball(events={"contact": None}), "None is not an event"),
    "an event that is a condition": (lambda: ball(events={"contact": x > 0}), "the condition x > 0 stands"),
    "an event with a corner": (lambda: ball(events={"contact": "abs(x)"}), "'abs' is not analytic"),
    "an event with a wrong field": (lambda: ball(events={"contact": {"functoin": x}}), "did you mean 'function'?"),
    "an event without function": (lambda: ball(events={"contact": {"kind": "section"}}), "an event needs 'function'"),
    "a mode as event": (lambda: ball(events={"contact": graze.Mode({})}), "is not an event"),
    "a text as transition": (lambda: ball(transitions=["contact"]), "'contact' is not a transition"),
    "transitions in a dict": (lambda: ball(transitions={"contact": 1}), "is no list"),
    "a transition with a wrong field": (lambda: ball(transitions=[{"event": "contact", "jmp": {}}]), "did you mean 'jump'?"),
    "a transition without event": (lambda: ball(transitions=[{}]), "a transition needs 'event'"),
    "a function as event": (lambda: ball(transitions=[T(2*x)]), "transitions[0].event: 2*x is no name"),
    "a transition without mode": (lambda: switched(transitions=[T("contact")]), "does not say in which mode"),
    "an unknown mode": (lambda: switched(transitions=[T("contact", mode="flihgt")]), "did you mean 'flight'?"),
    "an unknown next mode": (lambda: next_is("restt"), "transitions[0].next: there is no mode 'restt'"),
    "no alternative": (lambda: next_is([]), "transitions[0].next: there is no alternative"),
    "an equality": (lambda: next_is([(x == 0, "rest")]), "False is no condition; compare expressions by < <= > >="),
    "an equality in a text": (lambda: next_is([("x == 0", "rest")]), "transitions[0].next[0], character 3: '==' cannot"),
    "a condition without mode": (lambda: next_is((x > 0, "rest")), "the condition x > 0 stands without a mode"),
    "three items": (lambda: next_is([(x > 0, "rest", 1)]), "is no alternative"),
    "an alternative with a wrong field": (lambda: next_is([{"if": x > 0, "mode": "rest"}]), "an alternative has no 'if'"),
    "a number as next": (lambda: next_is(3), "transitions[0].next: 3 is no list"),
    "a number as next mode": (lambda: next_is([(x > 0, 3)]), "3 is no name of a mode"),
    "an unknown jump": (lambda: ball(transitions=[T("contact", jump="impct")], jumps={"impact": {v: -v}}),
                        "did you mean 'impact'?"),
    "a jump of no state": (lambda: ball(transitions=[T("contact", jump={"w": 1})]), "jump['w']: there is no state 'w'"),
    "a number as jump": (lambda: ball(transitions=[T("contact", jump=3)]), "3 is no dict"),
    "another identity": (lambda: ball(jumps={"identity": {v: -v}}), "jumps['identity']: the jump 'identity' exists always"),
    "jumps in a list": (lambda: ball(jumps=[{v: -v}]), "is no dict; give a dict from names to dicts"),
    "a jump of an expression": (lambda: ball(transitions=[T("contact", jump={v + 1: 1})]), "v + 1 is no name"),
    "chatter to nowhere": (lambda: switched(transitions=[T("contact", mode="flight", chatter="rst")]),
                           "transitions[0].chatter: there is no mode 'rst'"),
    "chatter of three": (lambda: switched(transitions=[T("contact", mode="flight", chatter=("a", "b", "c"))]),
                         "does not say where chatter leads"),
    "chatter with a wrong field": (lambda: switched(transitions=[T("contact", mode="flight", chatter={"mod": "rest"})]),
                                   "chatter has no 'mod'"),
    "an unknown watched event": (lambda: ball(watch=["contact", "top"]), "watch[1]: there is no event 'top'"),
    "an event watched twice": (lambda: ball(watch=["contact", "contact"]), "watch[1]: the model watches event 'contact' twice"),
    "a number as watch": (lambda: ball(watch=3), "Model(), watch: 3 is no list"),
    "watch beside modes": (lambda: switched(watch=["contact"]), "watch without rates"),
    "a mode named end": (lambda: switched(modes={"end": {x: v, v: -g}}, transitions=None), "a mode cannot be named 'end'"),
    "a mode with a wrong field": (lambda: switched(modes={"a": {"rates": {}, "wach": []}}), "did you mean 'watch'?"),
    "a slide of one mode": (lambda: switched(slides={"s": graze.Slide("contact", ["rest"])}),
                            "slides['s'].between: slides.s.between has 1 modes; name two"),
    "a slide without modes": (lambda: switched(slides={"s": {"surface": "contact"}}), "a slide needs 'between'"),
    "a slide of a wrong convention": (lambda: switched(slides={"s": graze.Slide("contact", ["rest", "flight"],
                                                                                convention="utkn")}),
                                      "slides['s'].convention: slides.s.convention cannot be 'utkn'"),
    "contacts without velocities": (lambda: ball(contacts=graze.Contacts({"wall": graze.Contact(v, 1)}, mass=[1])),
                                    "contacts.velocities names no state"),
    "a contact with friction but no slip": (lambda: ball(contacts=graze.Contacts(
        {"wall": graze.Contact(v, 1, friction=0.2)}, mass={v: 1})), "contacts.wall has no velocity along the surface"),
    "a friction without use": (lambda: ball(friction={"rub": graze.Friction(v, 1, 0.3)}),
                               "friction['rub']: no mode has the friction 'rub' in its rates"),
    "a friction with a wrong field": (lambda: ball(friction={"rub": {"velocity": v, "normal": 1, "coeff": 2}}),
                                      "a friction has no 'coeff'"),
    "an unknown initial mode": (lambda: switched(initial_mode="flyght"), "initial_mode: there is no mode 'flyght'"),
    "a number as initial mode": (lambda: switched(initial_mode=3), "initial_mode: 3 is no name"),
    "a section of both kinds": (lambda: ball(sections={"s": graze.Section(x, state=x, value=0)}), "either a function or a state"),
    "a section of nothing": (lambda: ball(sections={"s": graze.Section()}), "either a function or a state"),
    "a section without value": (lambda: ball(sections={"s": graze.Section(state=x)}), "state and value belong together"),
    "a section of no phase": (lambda: ball(sections={"s": graze.Section(state=x, value=0)}), "'x', which is not cyclic"),
    "a direction upwards": (lambda: ball(sections={"s": graze.Section(x, direction="up")}), "choose from falling, rising"),
    "a symmetry of no mode": (lambda: ball(symmetries={"s": graze.Symmetry({x: -x}, modes={"a": "b"})}),
                              "symmetries['s'].modes['a']: there is no mode 'a'"),
    "an expression as symmetry": (lambda: ball(symmetries={"s": -x}), "symmetries['s'].map: -x is no dict"),
    "a quantity named as a state": (lambda: ball(quantities={"x": v}), "quantities['x']: the name 'x' of a quantity"),
    "a number as text": (lambda: ball(text=3), "text: 3 is no text"),
    "a control character": (lambda: ball(text="\x1b[0m"), "Model(), text: text has characters in it"),
    "a text that is none": (lambda: graze.Model(text=3), "text is of type int"),
    "a text that is no model": (lambda: graze.Model(text="name = 3"), "name must be a string"),
    "a file that is none": (lambda: graze.Model(file=3), "3 is no path"),
    "an unknown shipped model": (lambda: graze.Model.shipped("impact-osillator"), "did you mean 'impact-oscillator'?"),
    "a number as shipped model": (lambda: graze.Model.shipped(3), "there is no shipped model 3"),
    "a number to load": (lambda: graze.load(3), "3 is no path"),
    "events beside a text": (lambda: graze.Model(text="x", events={}), "belongs to a model that is written by its"),
    "values in a number": (lambda: graze.Model(text=str(ball()), parameters=3), "parameters is no dict"),
    "an unknown parameter": (lambda: ball().parameters.update(ee=3), "there is no parameter 'ee'; did you mean 'e'?"),
    "a value in unknown names": (lambda: setattr(ball().parameters, "e", "2*gg"), "unknown name 'gg'; did you mean 'g'?"),
    "no value": (lambda: setattr(ball().parameters, "e", None), "e: None is no number"),
    "a value that is NaN": (lambda: setattr(ball().parameters, "e", math.nan), "is nan; give a finite number"),
    "a value of two": (lambda: setattr(ball().parameters, "e", numpy.ones(2)), "is no number"),
    "a value in states": (lambda: setattr(ball().parameters, "e", x), "unknown name 'x'"),
    "an unknown state": (lambda: ball().initial.update(y=3), "there is no state 'y'"),
    "an initial value without end": (lambda: setattr(ball().initial, "x", "1/0"), "has no finite value"),
    "an initial mode without equations": (lambda: setattr(ball(), "initial_mode", "y"), "there is no mode 'y'"),
    "a value of a state": (lambda: ball().value("x"), "unknown name 'x'"),
    "with_ of nothing": (lambda: ball().with_(q=3), "there is no parameter 'q'"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_a_mistake_is_told_as_one_of_the_call(wrong):
    call, words = WRONG[wrong]
    with pytest.raises(graze.ModelError) as told:
        call()
    assert words in str(told.value)
    assert "[[" not in str(told.value) and "model written in Python" not in str(told.value)
    assert str(pickle.loads(pickle.dumps(told.value))) == str(told.value)


@pytest.mark.parametrize("call, kind, words", [
    (lambda: ball(parameter=[g]), TypeError, "did you mean 'parameters'?"),
    (lambda: ball(gravity=3), TypeError, "Model() has no argument 'gravity'"),
    (lambda: graze.Model("a", "b"), TypeError, "positional"),
    (lambda: graze.Event(), TypeError, "function"),
    (lambda: graze.State("q", texts="a"), TypeError, "texts"),
    (lambda: graze.Model(file="/nowhere/x.toml"), graze.FileError, "/nowhere/x.toml"),
    (lambda: ball().save("/nowhere/x.toml"), graze.FileError, "cannot be written"),
    (lambda: ball().parameters.pop("e"), graze.InputError, "cannot be removed"),
    (lambda: ball().parameters["ee"], KeyError, "it has g, e"),
    (lambda: ball().parameters.ee, AttributeError, "it has g, e"),
    (lambda: ball().initial.y, AttributeError, "it has x, v"),
    (lambda: setattr(ball(), "name", "b"), AttributeError, "name"),
    (lambda: hash(ball()), TypeError, "unhashable"),
    (lambda: graze.states(""), graze.InputError, "no names are given"),
    (lambda: graze.states(3), graze.InputError, "3 are no names"),
    (lambda: graze.parameters(k=1, sin=2), graze.ModelError, "'sin' is a reserved name"),
])
def test_other_errors_are_those_of_python_or_of_files(call, kind, words):
    with pytest.raises(kind) as told:
        call()
    assert words in str(told.value)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(graze.ModelError) as told:
        ball(rates={x: "w", v: "-h"}, quantities={"energy": "v^2 +"})
    places = [one.file for one in told.value.all]
    assert places == ["Model(), rates['x']", "Model(), rates['v'], character 2",
                      "Model(), quantities['energy'], character 5"]
    assert all(isinstance(one, graze.ModelError) and (one.line, one.column) == (0, 0) for one in told.value.all)


def test_examples_of_docstrings_run():
    names = {name: getattr(graze, name) for name in dir(graze) if not name.startswith("_")}
    finder, runner = doctest.DocTestFinder(), doctest.DocTestRunner()
    for module in ("_model_parts", "_model", "_model_values", "_expressions"):
        for test in finder.find(sys.modules[f"graze.{module}"], globs=names):
            runner.run(test)
    assert runner.tries > 15 and runner.failures == 0
