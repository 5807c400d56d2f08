"""Results that are mappings from names to values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Dict, Iterable, Iterator


class Facts(Mapping):  # type: ignore[type-arg]
    """A mapping from names of facts to their values; of facts with the same name it has the first."""

    def __init__(self, names: Iterable[str], values: Iterable[Any]) -> None:
        self._values: Dict[str, Any] = {}
        for name, value in zip(names, values):
            self._values.setdefault(name, value)

    def __getitem__(self, name: str) -> Any:
        try:
            return self._values[name]
        except (KeyError, TypeError):
            raise KeyError(f"there is no fact {name!r}; there are {', '.join(self)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)
