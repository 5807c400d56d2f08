"""The text of a model file, made of the arguments of `Model`. The library reads that text, so there is one description of
what a model may be; mistakes are told as those of the arguments."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Dict, Iterator, List, Optional, Tuple

from ._arguments import near
from ._errors import Error, InputError, ModelError, as_kind, relocated
from ._expressions import Condition, Expression, short
from ._keywords import toml_text
from ._model_arguments import a_dict, a_list, key_of, mistake, part_of
from ._model_drawing import write_drawing
from ._model_lines import ModelLines
from ._model_parts import (Conserved, Contact, Contacts, Definition, Event, Friction, Interpolant, Jump, Mode, Parameter,
                           Quantity, Section, Slide, State, Symmetry, Transition)

FILE = "model written in Python"
ONLY_MODE = "motion"


class WrittenModel:
    """The text of a model file, made of the arguments of `Model`."""

    def __init__(self, name: Any, *, text: Any, source: Any, time_unit: Any, states: Any, parameters: Any,
                 definitions: Any, rates: Any, watch: Any, modes: Any, events: Any, jumps: Any, transitions: Any,
                 slides: Any, friction: Any, contacts: Any, sections: Any, symmetries: Any, quantities: Any,
                 conserved: Any, tables: Any, drawing: Any, initial_mode: Any) -> None:
        self._out = ModelLines()
        self._read_tables(tables)
        self._modes = self._read_modes(rates, watch, modes)
        self._single = rates is not None
        for key, value in {"name": "model" if name is None else name, "text": text, "source": source,
                           "time_unit": time_unit}.items():
            self._out.text(key, value, "")
        self._jumps = {} if jumps is None else {
            key: part_of(Jump, value, f"jumps['{key}']")
            for key, value in a_dict(jumps, "jumps", "a dict from names to dicts of changed states").items()}
        self._inline: Dict[str, Any] = {}
        transitions = self._read_transitions(transitions)
        self._write_symbols(Parameter, "parameters", parameters)
        self._write_symbols(State, "states", self._known_states() if states is None else states)
        self._write_symbols(Definition, "definitions", definitions)
        self._write_modes(transitions)
        self._write_events(events)
        self._write_jumps()
        self._write_transitions(transitions)
        self._write_slides(slides)
        self._write_friction(friction)
        self._write_contacts(contacts)
        self._write_sections(sections)
        self._write_symmetries(symmetries)
        self._write_quantities(quantities)
        self._write_conserved(conserved)
        write_drawing(self._out, drawing)
        self._out.write_tables()
        self._out.header("initial", label="initial_mode")
        first = next(iter(self._modes), "") if initial_mode is None else initial_mode
        self._out.name("mode", first, "initial_mode")
        self.text = "\n".join(self._out.lines) + "\n"

    # Reading the arguments.

    def _read_modes(self, rates: Any, watch: Any, modes: Any) -> Dict[str, Any]:
        if rates is not None and modes is not None:
            raise mistake("rates", "rates and modes contradict each other", "give rates to the modes")
        if rates is None:
            if watch is not None:
                raise mistake("watch", "watch without rates belongs to no mode", "give it to the modes")
            made = a_dict(modes, "modes", "a dict from names to graze.Mode")
            return {name: part_of(Mode, mode, f"modes['{name}']") for name, mode in made.items()}
        return {ONLY_MODE: Mode(rates, watch=watch)}

    def _mode_label(self, name: str, part: str) -> str:
        return part if self._single else f"modes['{name}'].{part}"

    def _known_states(self) -> List[Any]:
        """The states that have a rate."""
        found: Dict[str, State] = {}
        for name, mode in self._modes.items():
            label = self._mode_label(name, "rates")
            if not isinstance(mode.rates, Mapping):
                raise mistake(label, f"{short(mode.rates)} is no dict", "give a dict from states to their rates")
            for key in mode.rates:
                found.setdefault(key_of(key, label), key if isinstance(key, State) else State(key_of(key, label)))
        return list(found.values())

    def _symbols(self, kind: Any, group: str, given: Any) -> Dict[str, Any]:
        """Fields of each symbol by its name."""
        field = "initial" if kind is State else "value"
        result: Dict[str, dict] = {}
        if given is None:
            return result
        if isinstance(given, kind):
            given = [given]
        if not isinstance(given, Mapping):
            for one in a_list(given, group):
                if not isinstance(one, kind):
                    raise mistake(group, f"{short(one)} is no graze.{kind.__name__}",
                                   f"give graze.{kind.__name__}s, or a dict from names to values")
                if one.name in result:
                    raise mistake(group, f"'{one.name}' is given twice", "leave one of the two out")
                result[one.name] = dict(vars(one))
            return result
        known = list(vars(kind("x", 0)))
        objects = {key_of(key, group): key for key in given}
        for name, value in a_dict(given, group, "a dict from names to values").items():
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
                        raise mistake(label, f"a {kind._kind} has no '{key}'", near(key, known))
                fields.update(value)
            else:
                fields[field] = value
            result[name] = fields
        return result

    def _jump_name(self, jump: Any, event: str, label: str) -> Any:
        """The name of a jump that a transition names, or brings with it; None: the identity."""
        if jump is None or isinstance(jump, (str, Expression)):
            return None if jump is None else key_of(jump, label)
        for name, known in self._jumps.items():
            if known is jump:
                return name
        changes = part_of(Jump, jump, label)
        for name, (known, _) in self._inline.items():
            if known == changes:
                return name
        name, number = event, 1
        while name in self._jumps or name in self._inline or name == "identity":
            number += 1
            name = f"{event}-{number}"
        self._inline[name] = (changes, label)
        return name

    def _read_transitions(self, transitions: Any) -> List[Any]:
        """Labels and parts, with names for jumps and modes that are left out."""
        result = []
        if isinstance(transitions, Transition):
            transitions = [transitions]
        for number, one in enumerate([] if transitions is None else a_list(transitions, "transitions")):
            label = f"transitions[{number}]"
            one = part_of(Transition, one, label, by_first=False)
            event, mode = key_of(one.event, f"{label}.event"), one.mode
            if mode is None:
                if len(self._modes) != 1:
                    raise mistake(label, "the transition does not say in which mode it is", "give mode=...")
                mode = next(iter(self._modes))
            jump = self._jump_name(one.jump, event, f"{label}.jump")
            also = [one.also] if isinstance(one.also, (str, Expression)) else a_list(one.also, f"{label}.also")
            if one.when is not None and not isinstance(one.when, (Condition, str)):
                raise mistake(f"{label}.when", f"{short(one.when)} is no condition", "compare expressions by < <= > >=")
            result.append((label, Transition(event, mode=key_of(mode, f"{label}.mode"), jump=jump, label=one.label,
                                             next=self._read_next(one.next, mode, f"{label}.next"),
                                             chatter=self._read_chatter(one.chatter, event, f"{label}.chatter"),
                                             when=one.when, also=also)))
        return result

    def _read_next(self, given: Any, mode: Any, label: str) -> Any:
        """The name of a mode, or a list of pairs (condition or None, name)."""
        if given is None or isinstance(given, (str, Expression)):
            return key_of(mode if given is None else given, label)
        alternatives = a_list(given, label)
        if not alternatives:
            raise mistake(label, "there is no alternative", 'name a mode, or "end"')
        result = []
        for number, one in enumerate(alternatives):
            place = f"{label}[{number}]"
            if isinstance(one, str):
                one = (None, one)
            elif isinstance(one, Mapping):
                for key in one:
                    if key not in ("when", "mode"):
                        raise mistake(place, f"an alternative has no '{key}'", near(key, ("when", "mode")))
                one = (one.get("when"), one.get("mode"))
            elif isinstance(one, Condition):
                raise mistake(place, f"the condition {one} stands without a mode",
                               'give pairs in a list: [(condition, "mode"), "other mode"]')
            elif not isinstance(one, (tuple, list)) or len(one) != 2:
                raise mistake(place, f"{short(one)} is no alternative", 'give (condition, "mode"), or "mode"')
            when, name = one
            if when is not None and not isinstance(when, (Condition, str)):
                raise mistake(place, f"{short(when)} is no condition",
                               "compare expressions by < <= > >= (equality is a matter of round-off: make it an event)")
            if not isinstance(name, str):
                raise mistake(place, f"{short(name)} is no name of a mode", 'name a mode, or "end"')
            result.append((when, name))
        return result

    def _read_chatter(self, given: Any, event: str, label: str) -> Any:
        if given is None:
            return None
        if isinstance(given, str):
            return None, given
        if isinstance(given, Mapping):
            for key in given:
                if key not in ("jump", "mode"):
                    raise mistake(label, f"chatter has no '{key}'", near(key, ("jump", "mode")))
            given = (given.get("jump"), given.get("mode"))
        if not isinstance(given, (tuple, list)) or len(given) != 2 or not isinstance(given[1], str):
            raise mistake(label, f"{short(given)} does not say where chatter leads",
                           'name a mode, or give (jump, "mode")')
        return self._jump_name(given[0], event, label), given[1]

    # Writing the text.

    def _write_symbols(self, kind: Any, group: str, given: Any) -> None:
        out = self._out
        symbols = self._symbols(kind, group, given)
        if symbols:
            out.header(group, label=group)
        for name, fields in symbols.items():
            label = f"{group}['{name}']"
            out.header(group, name, label=label)
            value = fields.get("initial", 0) if kind is State else fields.get("value")
            if value is None:
                raise mistake(label, f"the {kind._kind} '{name}' has no value",
                               f"give it, as in {group}={{\"{name}\": 1}}")
            out.expression("initial" if kind is State else "value", value, label)
            for key in ("unit", "text"):
                out.text(key, fields.get(key), label)
            if fields.get("period") is not None:
                out.expression("period", fields["period"], f"{label}.period")
            drifting = fields.get("drifting", False)
            if not isinstance(drifting, bool):
                raise mistake(f"{label}.drifting", f"{short(drifting)} is neither True nor False", "give one of them")
            if drifting:
                out.add("drifting = true", f"{label}.drifting")

    def _read_tables(self, given: Any) -> None:
        """Tables that are used in texts; expressions bring theirs with them."""
        if given is None:
            return
        for number, one in enumerate([given] if isinstance(given, Interpolant) else a_list(given, "tables")):
            label = f"tables[{number}]"
            if not isinstance(one, Interpolant):
                raise mistake(label, f"{short(one)} is no graze.Interpolant", "give graze.Interpolant(name, points)")
            self._out.note_table(one._made(), label)

    def _write_map(self, given: Any, label: str) -> None:
        for name, value in a_dict(given, label, "a dict from states to expressions").items():
            self._out.expression(name, value, f"{label}['{name}']")

    def _write_modes(self, transitions: Any) -> None:
        for name, mode in self._modes.items():
            label = "rates" if self._single else f"modes['{name}']"
            self._out.header("modes", name, label=label)
            self._out.text("text", mode.text, label)
            self._write_watch(name, mode.watch, transitions)
            label = self._mode_label(name, "rates")
            self._out.header("modes", name, "rates", label=label)
            self._write_map(mode.rates, label)

    def _write_watch(self, mode: str, watch: Any, transitions: Any) -> None:
        """By default events are watched in the order of their transitions."""
        label = self._mode_label(mode, "watch")
        if watch is None:
            events: Dict[str, str] = {}
            for place, one in transitions:
                if one.mode == mode:
                    events.setdefault(one.event, f"{place}.event")
            watched = list(events.items())
        else:
            names = [watch] if isinstance(watch, (str, Expression)) else a_list(watch, label)
            watched = [(key_of(name, label), f"{label}[{number}]") for number, name in enumerate(names)]
        self._out.add("watch = [", label)
        for event, place in watched:
            self._out.add(f"    {toml_text(event)},", place)
        self._out.add("]", label)

    def _parts(self, kind: Any, group: str, given: Any, example: str) -> Iterator[Any]:
        if given is None:
            return
        for name, value in a_dict(given, group, example).items():
            label = f"{group}['{name}']"
            yield name, label, part_of(kind, value, label)

    def _write_events(self, events: Any) -> None:
        for name, label, event in self._parts(Event, "events", events, "a dict from names to functions"):
            self._out.header("events", name, label=label)
            self._out.expression("function", event.function, label)
            self._out.name("kind", event.kind, f"{label}.kind")
            self._out.text("text", event.text, label)

    def _write_jumps(self) -> None:
        jumps = {name: (jump, f"jumps['{name}']") for name, jump in self._jumps.items()}
        for name, (jump, label) in {**jumps, **self._inline}.items():
            self._out.header("jumps", name, label=label)
            changes = a_dict(jump.changes, label, "a dict from states to their values after the jump")
            if jump.text and "text" in changes:
                raise mistake(label, "a jump that changes the state 'text' cannot have a text", "leave it out")
            self._out.text("text", jump.text, label)
            self._write_map(changes, label)

    def _write_transitions(self, transitions: Any) -> None:
        out = self._out
        for label, one in transitions:
            out.add("")
            out.add("[[transitions]]", label)
            out.name("mode", one.mode, f"{label}.mode")
            out.name("event", one.event, f"{label}.event")
            out.text("label", one.label, label)
            if one.when is not None:
                begin = len('when = "') + 1 if isinstance(one.when, str) else 0
                out.add(f"when = {out.condition(one.when, label)}", f"{label}.when", begin)
            if one.also:
                self._names("also", one.also, f"{label}.also")
            if one.jump is not None:
                out.name("jump", one.jump, f"{label}.jump")
            if isinstance(one.next, str):
                out.name("next", one.next, f"{label}.next")
            else:
                out.add("next = [", f"{label}.next")
                for number, (when, mode) in enumerate(one.next):
                    condition = "" if when is None else f"when = {out.condition(when, label)}, "
                    out.add(f"    {{ {condition}mode = {toml_text(mode)} }},", f"{label}.next[{number}]",
                            len('    { when = "') + 1 if isinstance(when, str) else 0)
                out.add("]", f"{label}.next")
            if one.chatter is not None:
                jump, mode = one.chatter
                jump = "" if jump is None else f"jump = {toml_text(jump)}, "
                out.add(f"chatter = {{ {jump}mode = {toml_text(mode)} }}", f"{label}.chatter")

    def _names(self, key: str, given: Any, label: str) -> None:
        names = [key_of(name, label) for name in a_list(given, label)]
        self._out.add(f"{key} = [{', '.join(toml_text(name) for name in names)}]", label)

    def _write_slides(self, slides: Any) -> None:
        for name, label, slide in self._parts(Slide, "slides", slides, "a dict from names to graze.Slide"):
            self._out.header("slides", name, label=label)
            self._out.name("surface", slide.surface, f"{label}.surface")
            self._names("between", slide.between, f"{label}.between")
            if slide.convention is not None:
                self._out.name("convention", slide.convention, f"{label}.convention")
            if slide.control is not None:
                self._out.name("control", key_of(slide.control, f"{label}.control"), f"{label}.control")
            if slide.watch is not None:
                self._names("watch", slide.watch, f"{label}.watch")
            self._out.text("text", slide.text, label)

    def _write_friction(self, friction: Any) -> None:
        for name, label, one in self._parts(Friction, "friction", friction, "a dict from names to graze.Friction"):
            self._out.header("friction", name, label=label)
            for key in ("velocity", "normal", "coefficient", "static"):
                if getattr(one, key) is not None:
                    self._out.expression(key, getattr(one, key), f"{label}.{key}")
            self._out.text("text", one.text, label)

    def _write_contacts(self, given: Any) -> None:
        if given is None:
            return
        contacts = part_of(Contacts, given, "contacts")
        self._out.header("contacts", label="contacts")
        if contacts.law is not None:
            self._out.name("law", contacts.law, "contacts.law")
        mass, velocities = contacts.mass, contacts.velocities
        if isinstance(mass, Mapping):
            if velocities is not None:
                raise mistake("contacts.velocities", "the masses are given for their velocities", "leave velocities out")
            mass, velocities = list(mass.values()), list(mass)
        self._names("velocities", [] if velocities is None else velocities, "contacts.velocities")
        self._out.matrix("mass", a_list(mass, "contacts.mass"), "contacts.mass")
        if contacts.modes is not None:
            self._names("modes", contacts.modes, "contacts.modes")
        for name, label, one in self._parts(Contact, "contacts", contacts.contacts, "a dict from names to graze.Contact"):
            self._out.header("contacts", name, label=label)
            for key in ("gap", "restitution", "friction", "slip"):
                if getattr(one, key) is not None:
                    self._out.expression(key, getattr(one, key), f"{label}.{key}")
            self._out.text("text", one.text, label)

    def _write_sections(self, sections: Any) -> None:
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

    def _write_symmetries(self, symmetries: Any) -> None:
        for name, label, one in self._parts(Symmetry, "symmetries", symmetries, "a dict from names to graze.Symmetry"):
            self._out.header("symmetries", name, label=label)
            self._out.text("text", one.text, label)
            if one.map is not None:
                self._out.header("symmetries", name, "map", label=f"{label}.map")
                self._write_map(one.map, f"{label}.map")
            if one.modes is not None:
                self._out.header("symmetries", name, "modes", label=f"{label}.modes")
                for mode, image in a_dict(one.modes, f"{label}.modes", "a dict from modes to modes").items():
                    self._out.name(mode, image, f"{label}.modes['{mode}']")

    def _write_quantities(self, quantities: Any) -> None:
        example = "a dict from names to expressions"
        for name, label, quantity in self._parts(Quantity, "quantities", quantities, example):
            self._out.header("quantities", name, label=label)
            self._out.expression("value", quantity.value, label)
            self._out.text("unit", quantity.unit, label)
            self._out.text("text", quantity.text, label)

    def _write_conserved(self, conserved: Any) -> None:
        for name, label, one in self._parts(Conserved, "conserved", conserved, "a dict from names to expressions"):
            self._out.header("conserved", name, label=label)
            if one.value is not None:
                self._out.expression("value", one.value, label)
            self._out.text("unit", one.unit, label)
            self._out.text("text", one.text, label)
            if one.modes is not None:
                self._out.header("conserved", name, "modes", label=f"{label}.modes")
                for mode, own in a_dict(one.modes, f"{label}.modes", "a dict from modes to expressions").items():
                    self._out.expression(mode, own, f"{label}.modes['{mode}']")

    # Telling mistakes.

    def told(self, error: Error) -> Error:
        """An error of the library, with the argument in the place of the line of the text."""
        def place_of(one: Error) -> Optional[str]:
            if one.file != FILE:
                return None
            label, begin = "", 0
            if 0 < one.line <= len(self._out.labels):
                label, begin = self._out.labels[one.line - 1]
            place = f"Model(), {label}" if label else "Model()"
            if begin and one.column > begin:  # where a text begins needs no telling
                place += f", character {one.column - begin + 1}"
            return place

        result: Error = relocated(as_kind(error, ModelError) if isinstance(error, InputError) else error, place_of,
                                  self._in_words_of_python)
        return result

    def _in_words_of_python(self, text: str) -> str:
        for pattern, written in _WORDS:
            text = re.sub(pattern, written, text)
        if self._single:
            text = text.replace(f"modes.{ONLY_MODE}.", "").replace(f', mode="{ONLY_MODE}"', "")
            text = text.replace(f"mode '{ONLY_MODE}'", "the model")
        return text


# What the library says of a model file, and what that is in Python.
_WORDS: List[Tuple[str, Any]] = [
    (r"drawing\.shapes\.(\d+)", lambda found: f"drawing['shapes'][{int(found[1]) - 1}]"),
    (r"transitions\.(\d+)", lambda found: f"transitions[{int(found[1]) - 1}]"),
    (r"\.watch\.(\d+)", lambda found: f".watch[{int(found[1]) - 1}]"),
    (r", in \[states\]$", ", in states=..."),
    (r"in a mode, \[modes\.<name>\]", "as rates=..., or in modes=..."),
    (r'add \[\[transitions\]\] with mode = "(.*?)" and event = "(.*?)"', r'add graze.Transition("\2", mode="\1")'),
    (r"write one transition with alternatives: next = .*",
     'write one with alternatives: next=[(condition, "mode"), ...]'),
]
