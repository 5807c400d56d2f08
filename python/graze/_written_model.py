"""Models written in Python: states, parameters and definitions as symbols with fields, the other parts of a model, and
the text of a model file made of them. The library reads that text, so there is one description of what a model may be;
mistakes are told as those of the arguments of `Model`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Dict

from . import _graze
from ._errors import Error, InputError, ModelError, as_kind
from ._expressions import Condition, Expression, is_number, is_plain, number_of, short, words_of
from ._keywords import toml_key, toml_text

FILE = "model written in Python"
ONLY_MODE = "motion"


class _Symbol(Expression):
    """A symbol with fields."""

    _kind = ""

    def __new__(cls, name, *others, **fields):
        try:
            return super().__new__(cls, name)
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def __init__(self, name, **fields):
        vars(self).update(fields)

    @property
    def name(self) -> str:
        return str(self)

    def __reduce__(self):
        return _made_again, (type(self), str(self), dict(vars(self)))


def _made_again(kind, name, fields):
    return kind(name, **fields)


class State(_Symbol):
    """A state of a model, to be used in expressions.

    initial: its initial value, a number or an expression in parameters. unit, text: its unit and meaning.
    period: a number or expression makes the state cyclic: it is kept in [0, period).
    drifting: orbits are periodic up to a shift of this state.

    >>> theta = State("theta", period="2*pi", text="phase")
    """

    _kind = "state"
    initial: Any
    unit: str
    text: str
    period: Any
    drifting: bool

    def __init__(self, name: Any, initial: Any = 0, *, unit: str = "", text: str = "", period: Any = None,
                 drifting: bool = False) -> None:
        super().__init__(name, initial=initial, unit=unit, text=text, period=period, drifting=drifting)


class Parameter(_Symbol):
    """A parameter of a model, to be used in expressions.

    value: a number (the parameter is independent: it can be set later), or an expression in other parameters, which it
    then follows. unit, text: its unit and meaning.

    >>> f = Parameter("f", 50, unit="Hz")
    >>> omega = Parameter("omega", 2*3.14159*f)
    """

    _kind = "parameter"
    value: Any
    unit: str
    text: str

    def __init__(self, name: Any, value: Any = None, *, unit: str = "", text: str = "") -> None:
        super().__init__(name, value=value, unit=unit, text=text)


class Definition(_Symbol):
    """A name for an expression, to be used in other expressions. What several equations share is computed once, with or
    without a name; with one it is also shown by its name.

    >>> x, k = symbols("x k")
    >>> force = Definition("force", -k*x, text="of the spring")
    """

    _kind = "definition"
    value: Any
    text: str

    def __init__(self, name: Any, value: Any, *, text: str = "") -> None:
        super().__init__(name, value=value, text=text)


def _several(kind, called: str, names: str, values: dict):
    made = [kind(word) for word in words_of(names, called)] if not isinstance(names, str) or names or not values else []
    made += [kind(name, value) for name, value in values.items()]
    return made[0] if len(made) == 1 else tuple(made)


def states(names: str = "", **initial: Any) -> Any:
    """States by their names: one, or a tuple of several. By keyword, with their initial values (0 otherwise).

    >>> x, v = states("x v")
    >>> x, v = states(x=1, v=0)
    """
    return _several(State, "states", names, initial)


def parameters(names: str = "", **values: Any) -> Any:
    """Parameters by their names: one, or a tuple of several. By keyword, with their values.

    >>> k, c = parameters("k c")
    >>> k, c = parameters(k=1, c=0.1)
    """
    return _several(Parameter, "parameters", names, values)


class _Part:
    """A part of a model, which is what its fields say."""

    _what = ""

    def __eq__(self, other):
        return vars(self) == vars(other) if type(self) is type(other) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self):
        said = ", ".join(f"{name}={value!r}" for name, value in vars(self).items()
                         if not (value is None or isinstance(value, str) and value == ""))
        return f"{type(self).__name__}({said})"


class Mode(_Part):
    """The equations of motion between events.

    rates: a dict from states, or their names, to their time derivatives. watch: names of the events that can happen,
    of which simultaneous ones are processed in this order; by default those for which there is a transition in this
    mode. text: what the mode is.
    """

    _what = "a mode"

    def __init__(self, rates: Any, *, watch: Any = None, text: str = "") -> None:
        self.rates, self.watch, self.text = rates, watch, text


class Event(_Part):
    """An event: `function` falls through zero in a mode that watches it.

    kind: "barrier", which the motion must not cross, or "section", which only marks where something changes. text: what
    the event is.
    """

    _what = "an event"

    def __init__(self, function: Any, *, kind: str = "barrier", text: str = "") -> None:
        self.function, self.kind, self.text = function, kind, text


class Jump(_Part):
    """A map of states: `changes` is a dict from states, or their names, to their values after the jump, in terms of the
    states before. Other states stay as they are. text: what the jump is."""

    _what = "a jump"

    def __init__(self, changes: Any, *, text: str = "") -> None:
        self.changes, self.text = changes, text


class Transition(_Part):
    """The effect of an event in a mode.

    event: the name of the event. mode: the name of the mode (may be left out if there is only one).
    jump: the name of a jump, or a Jump or dict of changed states. Without it states stay as they are.
    next: the name of the mode that follows, or "end" for the end of the motion; by default the mode stays. Or a list of
        alternatives, pairs (condition, name) and at last perhaps a name: the first whose condition holds in the state
        after the jump is taken.
    chatter: how the motion goes on when contacts accumulate: the name of a mode, or a pair (jump, name).
    label: a name for signatures of orbits ("mode:event" if it is left out).

    >>> x, v = states("x v")
    >>> bounce = Transition("contact", jump={v: -0.8*v}, next=[(v > 0.01, "flight"), "rest"], mode="flight")
    """

    _what = "a transition"

    def __init__(self, event: Any, *, mode: Any = None, jump: Any = None, next: Any = None, chatter: Any = None,
                 label: str = "") -> None:
        self.event, self.mode, self.jump, self.next = event, mode, jump, next
        self.chatter, self.label = chatter, label


class Section(_Part):
    """A surface at which states are recorded: a zero of `function`, passed in the `direction` "falling", "rising" or
    "both" (the default); or where the cyclic `state` passes `value`. text: what the section is."""

    _what = "a section"

    def __init__(self, function: Any = None, *, state: Any = None, value: Any = None, direction: Any = None,
                 text: str = "") -> None:
        self.function, self.state, self.value = function, state, value
        self.direction, self.text = direction, text


class Symmetry(_Part):
    """A map that takes solutions of the model to solutions. map: the changed states, as in jumps; modes: a dict from
    each mode that is mapped to another one to that mode. text: what the symmetry is."""

    _what = "a symmetry"

    def __init__(self, map: Any = None, *, modes: Any = None, text: str = "") -> None:
        self.map, self.modes, self.text = map, modes, text


class Quantity(_Part):
    """A further expression for tables and figures, with its unit and meaning."""

    _what = "a quantity"

    def __init__(self, value: Any, *, unit: str = "", text: str = "") -> None:
        self.value, self.unit, self.text = value, unit, text


def _mistake(label: str, problem: str, remedy: str = "") -> ModelError:
    return ModelError(problem, remedy, f"Model(), {label}" if label else "Model()")


def near(name: str, known: Any) -> str:
    """A remedy that names what was perhaps meant."""
    from difflib import get_close_matches

    known = [str(one) for one in known]
    found = get_close_matches(str(name), known, 1)
    if found:
        return f"did you mean '{found[0]}'?"
    return f"known: {', '.join(known)}" if known else "there are none"


def _key(key, label: str) -> str:
    """The name that a key of a dict, or an entry of a list, says."""
    if isinstance(key, Expression) and key._is_symbol:
        return str(key)
    if isinstance(key, str):
        return key
    raise _mistake(label, f"{short(key)} is no name", "give a text, or a state, parameter or definition")


def _dict(value, label: str, example: str) -> dict:
    if not isinstance(value, Mapping):
        raise _mistake(label, f"{short(value)} is no dict", f"give {example}")
    result = {}
    for key, item in value.items():
        name = _key(key, label)
        if name in result:
            raise _mistake(label, f"'{name}' is given twice", "leave one of the two out")
        result[name] = item
    return result


def _list(value, label: str) -> list:
    if not isinstance(value, (str, Mapping, Expression)):
        try:
            return list(value)
        except TypeError:
            pass
    raise _mistake(label, f"{short(value)} is no list", "give a list")


def _part(kind, value, label: str, *, by_first=True):
    """A part that is given as such, as a dict of its fields, or (by_first) as its first field only."""
    if isinstance(value, kind):
        return value
    code = kind.__init__.__code__
    names = code.co_varnames[1:code.co_argcount + code.co_kwonlyargcount]
    fields = isinstance(value, Mapping)
    if fields and kind in (Mode, Jump, Symmetry):  # whose first field is a dict
        fields = names[0] in value or (kind is Symmetry and "modes" in value)
    if fields:
        for key in value:
            if key not in names:
                raise _mistake(label, f"{kind._what} has no '{key}'", near(key, names))
        for name in names[:code.co_argcount - 1 - len(kind.__init__.__defaults__ or ())]:
            if name not in value:
                raise _mistake(label, f"{kind._what} needs '{name}'", f"give it, or a graze.{kind.__name__}")
        return kind(**value)
    if by_first and value is not None and not isinstance(value, _Part):
        return kind(value)
    raise _mistake(label, f"{short(value)} is not {kind._what}", f"give a graze.{kind.__name__}")


class _Lines:
    """Lines of a text, and for each what argument it is about and in which column a text of the user's begins."""

    def __init__(self):
        self.lines, self.labels = [], []

    def add(self, line: str, label: str = "", begin: int = 0):
        if not is_plain(line):
            raise _mistake(ascii(label)[1:-1], "there are parts of characters that are no characters", "leave them out")
        self.lines.append(line)
        self.labels.append((label, begin))

    def header(self, *names: str, label: str = ""):
        self.add("")
        self.add(f"[{'.'.join(map(toml_key, names))}]", label)

    def expression(self, key: str, value, label: str):
        begin = len(f'{toml_key(key)} = "') + 1 if isinstance(value, str) else 0
        self.add(f"{toml_key(key)} = {_expression(value, label)}", label, begin)

    def text(self, key: str, value, label: str):
        if value is None or isinstance(value, str) and value == "":
            return
        if not isinstance(value, str):
            raise _mistake(f"{label}.{key}" if label else key, f"{short(value)} is no text", "give a text")
        self.add(f"{toml_key(key)} = {toml_text(value)}", f"{label}.{key}" if label else key)

    def name(self, key: str, value, label: str):
        self.add(f"{toml_key(key)} = {toml_text(_key(value, label))}", label)


def _expression(value, label: str) -> str:
    """An expression or number as a value of TOML."""
    if isinstance(value, Expression):
        return toml_text(str(value))
    if isinstance(value, str):
        return toml_text(value)
    remedy = "give a number or an expression"
    if isinstance(value, Condition):
        raise _mistake(label, f"the condition {value} stands where an expression belongs", remedy)
    if not is_number(value):
        raise _mistake(label, f"{short(value)} is neither a number nor an expression", remedy)
    if type(value) is int and abs(value) < 2**63:
        return repr(value)
    try:
        return repr(number_of(value))
    except InputError as error:
        raise _mistake(label, error.problem, remedy) from None


class WrittenModel:
    """The text of a model file, made of the arguments of `Model`."""

    def __init__(self, name: Any, *, text: Any, source: Any, time_unit: Any, states: Any, parameters: Any,
                 definitions: Any, rates: Any, watch: Any, modes: Any, events: Any, jumps: Any, transitions: Any,
                 sections: Any, symmetries: Any, quantities: Any, initial_mode: Any) -> None:
        self._out = _Lines()
        self._modes = self._read_modes(rates, watch, modes)
        self._single = rates is not None
        for key, value in {"name": "model" if name is None else name, "text": text, "source": source,
                           "time_unit": time_unit}.items():
            self._out.text(key, value, "")
        self._jumps = {} if jumps is None else {
            key: _part(Jump, value, f"jumps['{key}']")
            for key, value in _dict(jumps, "jumps", "a dict from names to dicts of changed states").items()}
        self._inline = {}
        transitions = self._read_transitions(transitions)
        self._write_symbols(Parameter, "parameters", parameters)
        self._write_symbols(State, "states", self._known_states() if states is None else states)
        self._write_symbols(Definition, "definitions", definitions)
        self._write_modes(transitions)
        self._write_events(events)
        self._write_jumps()
        self._write_transitions(transitions)
        self._write_sections(sections)
        self._write_symmetries(symmetries)
        self._write_quantities(quantities)
        self._out.header("initial", label="initial_mode")
        first = next(iter(self._modes), "") if initial_mode is None else initial_mode
        self._out.name("mode", first, "initial_mode")
        self.text = "\n".join(self._out.lines) + "\n"

    # Reading the arguments.

    def _read_modes(self, rates, watch, modes) -> dict:
        if rates is not None and modes is not None:
            raise _mistake("rates", "rates and modes contradict each other", "give rates to the modes")
        if rates is None:
            if watch is not None:
                raise _mistake("watch", "watch without rates belongs to no mode", "give it to the modes")
            made = _dict(modes, "modes", "a dict from names to graze.Mode")
            return {name: _part(Mode, mode, f"modes['{name}']") for name, mode in made.items()}
        return {ONLY_MODE: Mode(rates, watch=watch)}

    def _mode_label(self, name: str, part: str) -> str:
        return part if self._single else f"modes['{name}'].{part}"

    def _known_states(self) -> list:
        """The states that have a rate."""
        found: Dict[str, State] = {}
        for name, mode in self._modes.items():
            label = self._mode_label(name, "rates")
            if not isinstance(mode.rates, Mapping):
                raise _mistake(label, f"{short(mode.rates)} is no dict", "give a dict from states to their rates")
            for key in mode.rates:
                found.setdefault(_key(key, label), key if isinstance(key, State) else State(_key(key, label)))
        return list(found.values())

    def _symbols(self, kind, group: str, given) -> dict:
        """Fields of each symbol by its name."""
        field = "initial" if kind is State else "value"
        result: Dict[str, dict] = {}
        if given is None:
            return result
        if isinstance(given, kind):
            given = [given]
        if not isinstance(given, Mapping):
            for one in _list(given, group):
                if not isinstance(one, kind):
                    raise _mistake(group, f"{short(one)} is no graze.{kind.__name__}",
                                   f"give graze.{kind.__name__}s, or a dict from names to values")
                if one.name in result:
                    raise _mistake(group, f"'{one.name}' is given twice", "leave one of the two out")
                result[one.name] = dict(vars(one))
            return result
        known = list(vars(kind("x", 0)))
        objects = {_key(key, group): key for key in given}
        for name, value in _dict(given, group, "a dict from names to values").items():
            label = f"{group}['{name}']"
            fields = dict(vars(objects[name])) if isinstance(objects[name], kind) else {}
            if isinstance(value, kind):
                if value.name != name:  # one parameter that equals another one
                    fields[field] = value
                else:
                    fields.update(vars(value))
            elif isinstance(value, Mapping):
                for key in value:
                    if key not in known:
                        raise _mistake(label, f"a {kind._kind} has no '{key}'", near(key, known))
                fields.update(value)
            else:
                fields[field] = value
            result[name] = fields
        return result

    def _jump_name(self, jump, event: str, label: str):
        """The name of a jump that a transition names, or brings with it; None: the identity."""
        if jump is None or isinstance(jump, (str, Expression)):
            return None if jump is None else _key(jump, label)
        for name, known in self._jumps.items():
            if known is jump:
                return name
        changes = _part(Jump, jump, label)
        for name, (known, _) in self._inline.items():
            if known == changes:
                return name
        name, number = event, 1
        while name in self._jumps or name in self._inline or name == "identity":
            number += 1
            name = f"{event}-{number}"
        self._inline[name] = (changes, label)
        return name

    def _read_transitions(self, transitions) -> list:
        """Labels and parts, with names for jumps and modes that are left out."""
        result = []
        if isinstance(transitions, Transition):
            transitions = [transitions]
        for number, one in enumerate([] if transitions is None else _list(transitions, "transitions")):
            label = f"transitions[{number}]"
            one = _part(Transition, one, label, by_first=False)
            event, mode = _key(one.event, f"{label}.event"), one.mode
            if mode is None:
                if len(self._modes) != 1:
                    raise _mistake(label, "the transition does not say in which mode it is", "give mode=...")
                mode = next(iter(self._modes))
            jump = self._jump_name(one.jump, event, f"{label}.jump")
            result.append((label, Transition(event, mode=_key(mode, f"{label}.mode"), jump=jump, label=one.label,
                                             next=self._read_next(one.next, mode, f"{label}.next"),
                                             chatter=self._read_chatter(one.chatter, event, f"{label}.chatter"))))
        return result

    def _read_next(self, given, mode, label: str):
        """The name of a mode, or a list of pairs (condition or None, name)."""
        if given is None or isinstance(given, (str, Expression)):
            return _key(mode if given is None else given, label)
        alternatives = _list(given, label)
        if not alternatives:
            raise _mistake(label, "there is no alternative", 'name a mode, or "end"')
        result = []
        for number, one in enumerate(alternatives):
            place = f"{label}[{number}]"
            if isinstance(one, str):
                one = (None, one)
            elif isinstance(one, Mapping):
                for key in one:
                    if key not in ("when", "mode"):
                        raise _mistake(place, f"an alternative has no '{key}'", near(key, ("when", "mode")))
                one = (one.get("when"), one.get("mode"))
            elif isinstance(one, Condition):
                raise _mistake(place, f"the condition {one} stands without a mode",
                               'give pairs in a list: [(condition, "mode"), "other mode"]')
            elif not isinstance(one, (tuple, list)) or len(one) != 2:
                raise _mistake(place, f"{short(one)} is no alternative", 'give (condition, "mode"), or "mode"')
            when, name = one
            if when is not None and not isinstance(when, (Condition, str)):
                raise _mistake(place, f"{short(when)} is no condition",
                               "compare expressions by < <= > >= (equality is a matter of round-off: make it an event)")
            if not isinstance(name, str):
                raise _mistake(place, f"{short(name)} is no name of a mode", 'name a mode, or "end"')
            result.append((when, name))
        return result

    def _read_chatter(self, given, event: str, label: str):
        if given is None:
            return None
        if isinstance(given, str):
            return None, given
        if isinstance(given, Mapping):
            for key in given:
                if key not in ("jump", "mode"):
                    raise _mistake(label, f"chatter has no '{key}'", near(key, ("jump", "mode")))
            given = (given.get("jump"), given.get("mode"))
        if not isinstance(given, (tuple, list)) or len(given) != 2 or not isinstance(given[1], str):
            raise _mistake(label, f"{short(given)} does not say where chatter leads",
                           'name a mode, or give (jump, "mode")')
        return self._jump_name(given[0], event, label), given[1]

    # Writing the text.

    def _write_symbols(self, kind, group: str, given):
        out = self._out
        symbols = self._symbols(kind, group, given)
        if symbols:
            out.header(group, label=group)
        for name, fields in symbols.items():
            label = f"{group}['{name}']"
            out.header(group, name, label=label)
            value = fields.get("initial", 0) if kind is State else fields.get("value")
            if value is None:
                raise _mistake(label, f"the {kind._kind} '{name}' has no value",
                               f"give it, as in {group}={{\"{name}\": 1}}")
            out.expression("initial" if kind is State else "value", value, label)
            for key in ("unit", "text"):
                out.text(key, fields.get(key), label)
            if fields.get("period") is not None:
                out.expression("period", fields["period"], f"{label}.period")
            drifting = fields.get("drifting", False)
            if not isinstance(drifting, bool):
                raise _mistake(f"{label}.drifting", f"{short(drifting)} is neither True nor False", "give one of them")
            if drifting:
                out.add("drifting = true", f"{label}.drifting")

    def _write_map(self, given, label: str):
        for name, value in _dict(given, label, "a dict from states to expressions").items():
            self._out.expression(name, value, f"{label}['{name}']")

    def _write_modes(self, transitions):
        for name, mode in self._modes.items():
            label = "rates" if self._single else f"modes['{name}']"
            self._out.header("modes", name, label=label)
            self._out.text("text", mode.text, label)
            self._write_watch(name, mode.watch, transitions)
            label = self._mode_label(name, "rates")
            self._out.header("modes", name, "rates", label=label)
            self._write_map(mode.rates, label)

    def _write_watch(self, mode: str, watch, transitions):
        """By default events are watched in the order of their transitions."""
        label = self._mode_label(mode, "watch")
        if watch is None:
            events: Dict[str, str] = {}
            for place, one in transitions:
                if one.mode == mode:
                    events.setdefault(one.event, f"{place}.event")
            watched = list(events.items())
        else:
            names = [watch] if isinstance(watch, (str, Expression)) else _list(watch, label)
            watched = [(_key(name, label), f"{label}[{number}]") for number, name in enumerate(names)]
        self._out.add("watch = [", label)
        for event, place in watched:
            self._out.add(f"    {toml_text(event)},", place)
        self._out.add("]", label)

    def _parts(self, kind, group: str, given, example: str):
        if given is None:
            return
        for name, value in _dict(given, group, example).items():
            label = f"{group}['{name}']"
            yield name, label, _part(kind, value, label)

    def _write_events(self, events):
        for name, label, event in self._parts(Event, "events", events, "a dict from names to functions"):
            self._out.header("events", name, label=label)
            self._out.expression("function", event.function, label)
            self._out.name("kind", event.kind, f"{label}.kind")
            self._out.text("text", event.text, label)

    def _write_jumps(self):
        jumps = {name: (jump, f"jumps['{name}']") for name, jump in self._jumps.items()}
        for name, (jump, label) in {**jumps, **self._inline}.items():
            self._out.header("jumps", name, label=label)
            changes = _dict(jump.changes, label, "a dict from states to their values after the jump")
            if jump.text and "text" in changes:
                raise _mistake(label, "a jump that changes the state 'text' cannot have a text", "leave it out")
            self._out.text("text", jump.text, label)
            self._write_map(changes, label)

    def _write_transitions(self, transitions):
        out = self._out
        for label, one in transitions:
            out.add("")
            out.add("[[transitions]]", label)
            out.name("mode", one.mode, f"{label}.mode")
            out.name("event", one.event, f"{label}.event")
            out.text("label", one.label, label)
            if one.jump is not None:
                out.name("jump", one.jump, f"{label}.jump")
            if isinstance(one.next, str):
                out.name("next", one.next, f"{label}.next")
            else:
                out.add("next = [", f"{label}.next")
                for number, (when, mode) in enumerate(one.next):
                    condition = "" if when is None else f"when = {toml_text(str(when))}, "
                    out.add(f"    {{ {condition}mode = {toml_text(mode)} }},", f"{label}.next[{number}]",
                            len('    { when = "') + 1 if isinstance(when, str) else 0)
                out.add("]", f"{label}.next")
            if one.chatter is not None:
                jump, mode = one.chatter
                jump = "" if jump is None else f"jump = {toml_text(jump)}, "
                out.add(f"chatter = {{ {jump}mode = {toml_text(mode)} }}", f"{label}.chatter")

    def _write_sections(self, sections):
        for name, label, section in self._parts(Section, "sections", sections, "a dict from names to graze.Section"):
            self._out.header("sections", name, label=label)
            if section.function is not None:
                self._out.expression("function", section.function, label)
            if section.state is not None:
                self._out.name("state", section.state, f"{label}.state")
            if section.value is not None:
                self._out.expression("value", section.value, f"{label}.value")
            if section.direction is not None:
                self._out.name("direction", section.direction, f"{label}.direction")
            self._out.text("text", section.text, label)

    def _write_symmetries(self, symmetries):
        for name, label, one in self._parts(Symmetry, "symmetries", symmetries, "a dict from names to graze.Symmetry"):
            self._out.header("symmetries", name, label=label)
            self._out.text("text", one.text, label)
            if one.map is not None:
                self._out.header("symmetries", name, "map", label=f"{label}.map")
                self._write_map(one.map, f"{label}.map")
            if one.modes is not None:
                self._out.header("symmetries", name, "modes", label=f"{label}.modes")
                for mode, image in _dict(one.modes, f"{label}.modes", "a dict from modes to modes").items():
                    self._out.name(mode, image, f"{label}.modes['{mode}']")

    def _write_quantities(self, quantities):
        example = "a dict from names to expressions"
        for name, label, quantity in self._parts(Quantity, "quantities", quantities, example):
            self._out.header("quantities", name, label=label)
            self._out.expression("value", quantity.value, label)
            self._out.text("unit", quantity.unit, label)
            self._out.text("text", quantity.text, label)

    # Telling mistakes.

    def told(self, error: Error) -> Error:
        """An error of the library, with the argument in the place of the line of the text."""
        result = as_kind(error, ModelError) if isinstance(error, InputError) else error
        for one in result.all:
            if one.file != FILE:
                continue
            label, begin = "", 0
            if 0 < one.line <= len(self._out.labels):
                label, begin = self._out.labels[one.line - 1]
            one.file = f"Model(), {label}" if label else "Model()"
            if begin and one.column > begin:  # where a text begins needs no telling
                one.file += f", character {one.column - begin + 1}"
            one.line = one.column = 0
            one.problem, one.remedy = self._in_words_of_python(one.problem), self._in_words_of_python(one.remedy)
        return result

    def _in_words_of_python(self, text: str) -> str:
        for pattern, written in _WORDS:
            text = re.sub(pattern, written, text)
        if self._single:
            text = text.replace(f"modes.{ONLY_MODE}.", "").replace(f', mode="{ONLY_MODE}"', "")
            text = text.replace(f"mode '{ONLY_MODE}'", "the model")
        return text


# What the library says of a model file, and what that is in Python.
_WORDS: list = [
    (r"transitions\.(\d+)", lambda found: f"transitions[{int(found[1]) - 1}]"),
    (r"\.watch\.(\d+)", lambda found: f".watch[{int(found[1]) - 1}]"),
    (r", in \[states\]$", ", in states=..."),
    (r"in a mode, \[modes\.<name>\]", "as rates=..., or in modes=..."),
    (r'add \[\[transitions\]\] with mode = "(.*?)" and event = "(.*?)"', r'add graze.Transition("\2", mode="\1")'),
    (r"write one transition with alternatives: next = .*",
     'write one with alternatives: next=[(condition, "mode"), ...]'),
]
