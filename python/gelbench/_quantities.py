"""Quantities: plain numbers in mm, N and MPa, texts with a unit, and quantities of pint."""

from __future__ import annotations

import operator
import os
from collections.abc import Iterable, Mapping
from typing import Any, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import InputError, fault

__all__ = ["Floats", "PathLike", "Quantity", "SupportsUnits", "as_stated", "finite", "floats", "magnitudes", "number", "positive", "text", "texts", "toml", "pint_unit", "whole"]

Floats: TypeAlias = NDArray[np.float64]
PathLike: TypeAlias = "str | os.PathLike[str]"


@runtime_checkable
class SupportsUnits(Protocol):
    """The interface of pint quantities that is used."""

    @property
    def magnitude(self) -> Any: ...

    def to(self, other: Any, /) -> Any: ...


Quantity: TypeAlias = "float | str | SupportsUnits"
"""A number in mm, N or MPa, a text with a unit such as ``"5 cm"``, or a quantity of pint."""


def pint_unit(value: SupportsUnits) -> str:
    """The unit of a pint quantity as in studies: ``N/mm^2``."""
    return f"{getattr(value, 'units', ''):~C}".replace("**", "^")


def as_stated(value: SupportsUnits) -> str:
    """A pint quantity as a text in its own unit."""
    return f"{float(value.magnitude)!r} {pint_unit(value)}".rstrip()


def texts(values: Mapping[str, Any], units: Mapping[str, str], argument: str) -> dict[str, Any]:
    """The values of keys as in a study's text: those of keys with a unit, alone or in lists, as quantities."""
    if not isinstance(values, Mapping):
        raise fault(argument, f"is {values!r}", 'give its keys and values, such as {"key": value}')

    def of(key: str, value: Any) -> Any:
        if key not in units:
            return value
        if isinstance(value, (str, bytes)) or not np.iterable(value):
            return text(value, units[key], f"{argument}.{key}")
        return [text(one, units[key], f"{argument}.{key}") for one in value]

    return {key: of(key, value) for key, value in values.items()}


def text(value: Any, unit: str, argument: str) -> str:
    """A quantity as in a study's text; `unit` applies to plain numbers."""
    if isinstance(value, str):
        return value
    if isinstance(value, SupportsUnits) and not unit:
        return as_stated(value)
    if isinstance(value, SupportsUnits):
        value = converted(value, unit, argument)
    try:
        plain = float(value)
        if isinstance(value, (bool, np.bool_)) or np.isnan(plain):
            raise ValueError(value)
    except (TypeError, ValueError):
        hint = f'a number in {unit or "1"}, or a text with a unit'
        raise fault(argument, f"{value!r} is not a quantity", hint) from None
    return f"{plain!r} {unit}".rstrip()


def number(value: Any, unit: str, argument: str) -> float:
    """A quantity as a number in `unit`."""
    try:
        return _core.quantity(text(value, unit, argument), unit)
    except InputError as wrong:
        raise fault(argument, str(wrong), f'give a number in {unit or "1"}, or a text with a unit') from None


def positive(value: Any, unit: str, argument: str) -> float | None:
    """A quantity greater than zero as a number in `unit`; None remains."""
    if value is None:
        return None
    found = number(value, unit, argument)
    if not 0.0 < found < np.inf:
        raise fault(argument, f"is {value!r}", "it must be greater than zero")
    return found


def converted(value: SupportsUnits, unit: str, argument: str) -> Any:
    """The numbers of a pint quantity in a unit; empty or ``-`` means dimensionless."""
    wanted = "dimensionless" if unit in ("", "-", "–") else unit
    try:
        return value.to(wanted).magnitude
    except Exception as cause:
        raise fault(argument, str(cause), f"give it in {wanted}, or in a unit that can be converted") from None


def magnitudes(value: Any, argument: str, unit: str = "") -> Any:
    """Anything array-like without units: quantities of pint, and lists of them, are converted."""
    if hasattr(value, "magnitude") and isinstance(value, SupportsUnits):
        return converted(value, unit, argument)
    if isinstance(value, (list, tuple)) and any(isinstance(one, (list, tuple)) or hasattr(one, "magnitude") for one in value):
        return [magnitudes(one, argument, unit) for one in value]
    return value


def refuse_masked(value: Any, argument: str) -> None:
    """Refuses masked entries where every entry is needed."""
    if np.ma.is_masked(value):
        count = int(np.sum(np.ma.getmaskarray(value)))
        raise fault(argument, f"has {count} masked entries", "fill in the values, or leave out the entries")


def array_of(value: Any, argument: str, unit: str = "", *, missing: bool = False) -> Floats:
    """An array of floats; masked entries become NaN where missing values are allowed, otherwise they are refused."""
    plain = magnitudes(value, argument, unit)
    is_masked = np.ma.isMaskedArray(plain)
    if is_masked and not missing:
        refuse_masked(plain, argument)
    try:
        found: Floats = np.ma.filled(plain.astype(np.float64), np.nan) if is_masked else np.asarray(plain, dtype=np.float64)
        return found
    except (TypeError, ValueError):
        raise fault(argument, "is not an array of numbers", "give floats") from None


def floats(
    value: Any, argument: str, shape: tuple[int | None, ...], unit: str = "", *, missing: bool = False
) -> Floats:
    """A contiguous array in the machine's byte order, of a shape in which ``None`` stands for any length."""
    array = array_of(value, argument, unit, missing=missing)
    array = np.require(array, requirements="C")
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


def whole(value: Any, argument: str, least: int = 0) -> int:
    """A whole number that is not less than `least`."""
    try:
        plain: Any = int(value) if isinstance(value, (float, np.floating)) and float(value).is_integer() else value
        found = operator.index(plain)
    except TypeError:
        found = least - 1
    if found < least:
        raise fault(argument, f"is {value!r}", f"it must be a whole number, {least} or more")
    return found


def scalar(value: Any) -> str | None:
    """A boolean or a number as in a study; None for anything else."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return None


def _value(value: Any) -> str:
    if isinstance(value, SupportsUnits) and np.ndim(value.magnitude) == 0:
        value = as_stated(value)
    text = scalar(value)
    if text is not None:
        return text
    if isinstance(value, str):
        escapes = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}
        return '"' + "".join(escapes.get(letter, letter) for letter in value) + '"'
    if isinstance(value, Iterable):
        items: Iterable[Any] = value
        return "[" + ", ".join(_value(one) for one in items) + "]"
    raise fault("settings", f"{value!r} is not possible in a study", "give texts, numbers, booleans, or lists of them")


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
