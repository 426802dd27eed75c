"""Energies written in Python as formulas, which the library differentiates."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from ._errors import fault
from ._quantities import toml

__all__ = ["Energy", "card_of"]

Energy: TypeAlias = "Callable[..., Any]"
"""``lambda i1, i2: …``, ``lambda C: …`` or ``lambda F: …``, of numbers and NumPy's functions."""

LONGEST = 200_000
"""Characters of a formula; one that repeats its parts grows with every repetition."""

BINARY = {"add": "+", "subtract": "-", "multiply": "*", "divide": "/", "power": "^", "float_power": "^"}
FUNCTIONS = {name: name for name in ("exp", "expm1", "log", "log1p", "sqrt", "sin", "cos", "sinh", "cosh", "tanh")} | {"absolute": "abs"}
PAIRS = {"maximum": "max", "minimum": "min", "fmax": "max", "fmin": "min"}


def _not_a_formula(message: str) -> Exception:
    known = ", ".join(sorted(FUNCTIONS)) + ", square, maximum and minimum"
    return fault("energy", message, f"write a formula of + - * / ** and NumPy's {known}; for a condition, such as np.maximum(i4 - 1, 0)")


class _Formula(np.lib.mixins.NDArrayOperatorsMixin):
    """What NumPy's operations on a variable write down."""

    __slots__ = ("text",)

    def __init__(self, text: str) -> None:
        if len(text) > LONGEST:
            raise fault("energy", "is too long as one formula", "repeat its parts less often")
        self.text = text

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        if any(isinstance(one, np.ndarray) and one.ndim > 0 for one in inputs):
            objects = [np.asarray(one, dtype=object) if isinstance(one, np.ndarray) else _scalar(one) for one in inputs]
            return getattr(ufunc, method)(*objects, **options)
        texts = [_text(one) for one in inputs]
        name = ufunc.__name__
        if method != "__call__" or options:
            raise _not_a_formula(f"takes numpy.{name}.{method}")
        if name in BINARY:
            return _Formula(f"({texts[0]} {BINARY[name]} {texts[1]})")
        if name in PAIRS:
            return _Formula(f"{PAIRS[name]}({texts[0]}, {texts[1]})")
        if name in FUNCTIONS:
            return _Formula(f"{FUNCTIONS[name]}({texts[0]})")
        if name == "negative":
            return _Formula(f"(-{texts[0]})")
        if name == "positive":
            return self
        if name == "square":
            return _Formula(f"({texts[0]} ^ 2)")
        raise _not_a_formula(f"takes numpy.{name}, which is no part of a formula")

    def __bool__(self) -> bool:
        raise _not_a_formula("decides by a value that is not known yet")

    def __float__(self) -> float:
        raise _not_a_formula("takes a function of the module math, or a number of a value that is not known yet")

    def __getattr__(self, name: str) -> Any:
        # NumPy's functions of arrays of objects are their methods.
        ufunc = getattr(np, name, None)
        if isinstance(ufunc, np.ufunc):
            return lambda: ufunc(self)
        raise AttributeError(name)


def _scalar(value: Any) -> Any:
    return np.array(value, dtype=object) if isinstance(value, _Formula) else value


def _text(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, _Formula):
        return value.text
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise _not_a_formula(f"contains {value!r}") from None
    return f"({number!r})" if number < 0 else repr(number)


def _gradient(c11: Any, c12: Any, c22: Any) -> Any:
    """F of an incompressible sheet with C = FᵀF, without rotation of the first axis."""
    f11 = np.sqrt(c11)
    f12 = c12 / f11
    f22 = np.sqrt(c22 - f12**2)
    return np.array([[f11, f12, 0.0], [0.0, f22, 0.0], [0.0, 0.0, 1.0 / (f11 * f22)]], dtype=object)


def _traced(energy: Energy, *variables: Any) -> Any:
    """The value of a callable of variables."""
    try:
        return energy(*variables)
    except TypeError as cause:
        # Functions of numpy.linalg take numbers alone.
        raise _not_a_formula(f"takes what is no part of a formula: {cause}") from cause


def _formula(energy: Energy) -> str:
    """The formula that a callable writes."""
    try:
        names = [name.lower() for name in inspect.signature(energy).parameters]
    except (TypeError, ValueError):
        names = []
    if names in (["i1"], ["i1", "i2"]):
        value = _traced(energy, *(_Formula(name.upper()) for name in names))
    elif names in (["c"], ["f"]):
        c11, c12, c22 = (_Formula(name) for name in ("C11", "C12", "C22"))
        gradient = _gradient(c11, c12, c22)
        if names == ["f"]:
            _check_objectivity(energy)
            value = _traced(energy, gradient)
        else:
            across = 1.0 / (c11 * c22 - c12**2)
            value = _traced(energy, np.array([[c11, c12, 0.0], [c12, c22, 0.0], [0.0, 0.0, across]], dtype=object))
    else:
        raise fault("energy", f"is a function of {', '.join(names) or 'nothing'}", "it must be one of i1 and i2, of i1, of C, or of F")
    if value is None:
        raise fault("energy", "returns nothing", "return Ψ in MPa")
    return _text(value)


def _check_objectivity(energy: Energy) -> None:
    """The energy of F must be that of R F for each rotation R."""
    for angle, (c11, c12, c22) in ((0.7, (1.3, 0.2, 0.9)), (2.1, (0.8, -0.1, 1.4))):
        gradient = _gradient(c11, c12, c22).astype(float)
        cosine, sine = np.cos(angle), np.sin(angle)
        turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]) @ gradient
        here, there = float(energy(gradient)), float(energy(turned))
        if not abs(here - there) <= 1e-9 * max(abs(here), abs(there)):
            raise fault("energy", f"changes from {here:g} to {there:g} MPa where the sheet is turned", "it must depend on F.T @ F alone")


def card_of(energy: Energy, name: str, stretch_range: Sequence[float]) -> str:
    """The card of a law with this energy."""
    try:
        low, high = (float(one) for one in stretch_range)
    except (TypeError, ValueError):
        low = high = np.nan
    if not (0.0 < low < high < np.inf):
        raise fault("stretch_range", f"is {stretch_range!r}", "it must be two increasing stretches, such as (0.5, 3.0)")
    return toml(
        {
            "title": name,
            "law": "energy",
            "parameters": {"energy": _formula(energy)},
            "data": {
                "test": "none",
                "stress_measure": "nominal",
                "strain_measure": "nominal",
                "offset": "subtract",
                "stretch_range": [low, high],
            },
            "source": {"citation": "not stated", "specimen": "not stated"},
        }
    )
