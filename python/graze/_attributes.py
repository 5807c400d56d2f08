"""Objects that take no other attributes: a name that is misspelt is told, where Python would keep it unseen."""

from __future__ import annotations

from typing import Any


class Fixed:
    """An object that takes no other attributes than private ones and those that its class names, as annotations too."""

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_") and not _is_named(type(self), name):
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r} that can be set; {self._instead(name)}")
        super().__setattr__(name, value)

    def _instead(self, name: str) -> str:
        """What to do instead of setting an attribute that there is not."""
        return "keep other things in a variable of your own"


def _is_named(kind: type, name: str) -> bool:
    return hasattr(kind, name) or any(name in vars(one).get("__annotations__", ()) for one in kind.__mro__)
