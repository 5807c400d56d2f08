"""The lines of a model file that is written from arguments."""

from __future__ import annotations

from typing import Any, List, Tuple

from ._errors import InputError
from ._expressions import Condition, Expression, is_number, is_plain, number_of, short
from ._keywords import toml_key, toml_text
from ._model_arguments import key_of, mistake


class ModelLines:
    """Lines of a text, and for each what argument it is about and in which column a text of the user's begins."""

    def __init__(self) -> None:
        self.lines: List[str] = []
        self.labels: List[Tuple[str, int]] = []

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
        self.add(f"{toml_key(key)} = {expression_text(value, label)}", label, begin)

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
            return ", ".join(expression_text(one, f"{name}[{place}]") for place, one in enumerate(entries))

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
