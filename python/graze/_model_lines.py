"""The lines of a model file that is written from arguments."""

from __future__ import annotations

from typing import Any, Dict, List, Tuple

from ._errors import InputError
from ._expressions import Condition, Expression, is_number, is_plain, number_of, short
from ._keywords import toml_key, toml_text
from ._model_arguments import key_of, mistake


class ModelLines:
    """Lines of a text, and for each what argument it is about and in which column a text of the user's begins."""

    def __init__(self) -> None:
        self.lines: List[str] = []
        self.labels: List[Tuple[str, int]] = []
        self.tables: Dict[str, Any] = {}  # that expressions look up

    def add(self, line: str, label: str = "", begin: int = 0) -> None:
        if not is_plain(line):
            raise mistake(ascii(label)[1:-1], "there are parts of characters that are no characters", "leave them out")
        self.lines.append(line)
        self.labels.append((label, begin))

    def header(self, *names: str, label: str = "") -> None:
        self.add("")
        self.add(f"[{'.'.join(map(toml_key, names))}]", label)

    def expression(self, key: str, value: Any, label: str) -> None:
        begin = len(f'{toml_key(key)} = "') + 1 if isinstance(value, str) else 0
        self.add(f"{toml_key(key)} = {self.value(value, label)}", label, begin)

    def value(self, value: Any, label: str) -> str:
        """An expression as a value of TOML; the tables that it looks up are noted."""
        for table in value._tables if isinstance(value, Expression) else []:
            self.note_table(table, label)
        return expression_text(value, label)

    def condition(self, value: Any, label: str) -> str:
        for table in value.tables if isinstance(value, Condition) else []:
            self.note_table(table, label)
        return toml_text(str(value))

    def note_table(self, table: Any, label: str) -> None:
        name = table.parts[0]
        if self.tables.setdefault(name, table).parts != table.parts:
            raise mistake(label, f"two different tables have the name '{name}'", "rename one of them")

    def write_tables(self) -> None:
        for table in self.tables.values():
            name, points, interpolation, periodic, outside, text = table.parts
            label = f"tables['{name}']"
            self.header("tables", name, label=label)
            self.text("text", text, label)
            self.add(f"points = [{', '.join(f'[{x!r}, {f!r}]' for x, f in points)}]", f"{label}.points")
            self.name("interpolation", interpolation, label)
            if periodic:
                self.add("periodic = true", label)
            else:
                self.name("outside", outside, label)

    def text(self, key: str, value: Any, label: str) -> None:
        if value is None or isinstance(value, str) and value == "":
            return
        if not isinstance(value, str):
            raise mistake(f"{label}.{key}" if label else key, f"{short(value)} is no text", "give a text")
        self.add(f"{toml_key(key)} = {toml_text(value)}", f"{label}.{key}" if label else key)

    def name(self, key: str, value: Any, label: str) -> None:
        self.add(f"{toml_key(key)} = {toml_text(key_of(value, label))}", label)

    def matrix(self, key: str, values: List[Any], label: str) -> None:
        """Writes a list of expressions, or of lists of them."""
        def row(entries: Any, name: str) -> str:
            return ", ".join(self.value(one, f"{name}[{place}]") for place, one in enumerate(entries))

        rows = [f"[{row(one, f'{label}[{place}]')}]" if isinstance(one, (list, tuple)) else row([one], label)
                for place, one in enumerate(values)]
        self.add(f"{toml_key(key)} = [{', '.join(rows)}]", label)


def expression_text(value: Any, label: str) -> str:
    """An expression or number as a value of TOML."""
    if isinstance(value, Expression):
        return toml_text(str(value))
    if isinstance(value, str):
        return toml_text(value)
    remedy = "give a number or an expression"
    if isinstance(value, Condition):
        raise mistake(label, f"the condition {value} stands where an expression belongs", remedy)
    if not is_number(value):
        raise mistake(label, f"{short(value)} is neither a number nor an expression", remedy)
    if type(value) is int and abs(value) < 2**63:
        return repr(value)
    try:
        return repr(number_of(value))
    except InputError as error:
        raise mistake(label, error.problem, remedy) from None
