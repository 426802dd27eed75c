"""Quantities: plain numbers in mm, N and MPa, texts with a unit, and quantities of pint."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import fault

__all__ = ["Floats", "PathLike", "Quantity", "SupportsUnits", "floats", "number", "text", "toml"]

Floats: TypeAlias = NDArray[np.float64]
PathLike: TypeAlias = "str | os.PathLike[str]"


@runtime_checkable
class SupportsUnits(Protocol):
    """What pint's quantities can do."""

    @property
    def magnitude(self) -> Any: ...

    def to(self, other: Any, /) -> Any: ...


Quantity: TypeAlias = "float | str | SupportsUnits"
"""A number in mm, N or MPa, a text with a unit such as ``"5 cm"``, or a quantity of pint."""


def text(value: Any, unit: str, argument: str) -> str:
    """A quantity as a study's text has it; `unit` is that of plain numbers."""
    if isinstance(value, str):
        return value
    if isinstance(value, SupportsUnits):
        value = value.to(unit or "dimensionless").magnitude
    try:
        plain = float(value)
    except (TypeError, ValueError):
        hint = f'a number in {unit or "1"}, or a text with a unit'
        raise fault(argument, f"{value!r} is no quantity", hint) from None
    return f"{plain!r} {unit}".rstrip()


def number(value: Any, unit: str, argument: str) -> float:
    """A quantity as a number in `unit`."""
    return _core.quantity(text(value, unit, argument), unit)


def floats(value: ArrayLike, argument: str, shape: tuple[int | None, ...]) -> Floats:
    """A contiguous array in the machine's byte order, of a shape in which ``None`` stands for any length."""
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise fault(argument, "is no array of numbers", "give floats") from None
    fits = len(array.shape) == len(shape) and all(
        want is None or own == want for own, want in zip(array.shape, shape, strict=True)
    )
    if not fits:
        wanted = " × ".join("n" if own is None else str(own) for own in shape)
        raise fault(argument, f"has the shape {array.shape}", f"it must be {wanted}")
    return array


def finite(array: Floats, argument: str) -> Floats:
    """An array without NaN and infinity."""
    if not np.isfinite(array).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise fault(argument, f"holds {array[place]} at {list(place)}", "every entry must be a number")
    return array


def scalar(value: Any) -> str | None:
    """A truth or a number as a study has it; nothing of anything else."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return None


def _value(value: Any) -> str:
    text = scalar(value)
    if text is not None:
        return text
    if isinstance(value, str):
        escapes = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}
        return '"' + "".join(escapes.get(letter, letter) for letter in value) + '"'
    if isinstance(value, Iterable):
        items: Iterable[Any] = value
        return "[" + ", ".join(_value(one) for one in items) + "]"
    raise TypeError(f"{value!r} cannot stand in a study")


def toml(sections: Mapping[str, Any]) -> str:
    """A study's text: values, tables, and lists of tables."""
    plain: list[str] = []
    tables: list[str] = []
    for key, value in sections.items():
        if isinstance(value, Mapping):
            own: Mapping[str, Any] = value
            if own:
                tables += ["", f"[{key}]"] + [f"{name} = {_value(one)}" for name, one in own.items()]
        elif isinstance(value, list) and value and all(isinstance(one, Mapping) for one in value):
            rows: list[Mapping[str, Any]] = value
            for row in rows:
                tables += ["", f"[[{key}]]"] + [f"{name} = {_value(one)}" for name, one in row.items()]
        else:
            plain.append(f"{key} = {_value(value)}")
    return "\n".join(plain + tables) + "\n"
