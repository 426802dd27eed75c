"""Laws written in Python: their return values and how these are checked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ._errors import fault
from ._quantities import Floats, toml

__all__ = ["Derivatives", "Law", "card_in_place", "checked_range", "rows_of"]


class Derivatives(NamedTuple):
    """Energy of a law Ψ(I₁, I₂) and its derivatives, each a number or an array like I₁.

    Energy and derivatives are per volume at rest: MPa = mJ/mm³.
    """

    energy: ArrayLike
    """Ψ, zero at rest (I₁ = I₂ = 3)."""
    d1: ArrayLike
    """∂Ψ/∂I₁."""
    d2: ArrayLike = 0.0
    """∂Ψ/∂I₂."""
    d11: ArrayLike = 0.0
    """∂²Ψ/∂I₁²."""
    d12: ArrayLike = 0.0
    """∂²Ψ/∂I₁∂I₂."""
    d22: ArrayLike = 0.0
    """∂²Ψ/∂I₂²."""


Law: TypeAlias = "Callable[[Floats, Floats], Derivatives]"
"""Arrays of I₁ and I₂ to energy and derivatives."""

Rows: TypeAlias = "Callable[[Floats, Floats], Floats]"
"""Arrays of I₁ and I₂ to energy and derivatives, n × 6."""


def rows_of(evaluate: Law, stretch_range: tuple[float, float]) -> Rows:
    """A law as the library evaluates it, with its derivatives compared with finite differences within a range of stretches."""

    def rows(i1: Floats, i2: Floats) -> Floats:
        found = Derivatives(*evaluate(i1, i2))
        table = np.empty((i1.size, 6))
        for column, (what, values) in enumerate(zip(Derivatives._fields, found, strict=True)):
            try:
                table[:, column] = values
            except ValueError:
                message = f"{what} has the shape {np.shape(values)}"
                raise fault("evaluate", message, f"it must be a number or have {i1.size} entries") from None
        return table

    _check_derivatives(rows, stretch_range)
    _check_rest(rows)
    return rows


def checked_range(stretch_range: Sequence[float]) -> tuple[float, float]:
    """The range of stretches in which a law is valid."""
    try:
        low, high = (float(one) for one in stretch_range)
    except (TypeError, ValueError):
        low = high = np.nan
    if not (0.0 < low < high < np.inf):
        raise fault("stretch_range", f"is {stretch_range!r}", "it must be two increasing stretches, such as (0.5, 3.0)")
    return low, high


def card_in_place(title: str, shear_modulus: float, stretch_range: tuple[float, float]) -> str:
    """The placeholder card with which a study of a law in Python is read: neo-Hooke with the same modulus and range."""
    return toml(
        {
            "title": title or "a law in Python",
            "law": "neo-hooke",
            "parameters": {"c10": f"{0.5 * shear_modulus!r} MPa"},
            "data": {
                "test": "none",
                "stress_measure": "nominal",
                "strain_measure": "nominal",
                "offset": "subtract",
                "stretch_range": list(stretch_range),
            },
            "source": {"citation": "not stated", "specimen": "not stated"},
        }
    )


def _check_rest(rows: Rows) -> None:
    """At rest the energy is zero and the shear modulus positive."""
    energy, d1, d2 = rows(np.array([3.0]), np.array([3.0]))[0, :3]
    modulus = 2.0 * (d1 + d2)
    if not modulus > 0.0:
        message = f"the shear modulus at rest, 2 (d1 + d2), is {modulus:g} MPa"
        raise fault("evaluate", message, "d1 + d2 must be positive at I₁ = I₂ = 3")
    if not abs(energy) <= 1e-9 * modulus:
        raise fault("evaluate", f"the energy at rest is {energy:g} MPa", "subtract it, so that it is 0 at I₁ = I₂ = 3")


def _check_derivatives(rows: Rows, stretch_range: tuple[float, float]) -> None:
    """Compares the derivatives of a law with finite differences wherever both in-plane stretches are within the range."""
    stretches = np.geomspace(*stretch_range, 25)
    first, second = (own.ravel() for own in np.meshgrid(stretches, stretches))
    squares = np.stack([first, second, 1 / (first * second)]) ** 2
    i1, i2 = squares.sum(axis=0), (1 / squares).sum(axis=0)
    # At rest differences would leave the invariants that sheets can have.
    ahead = (first <= second) & (np.minimum(i1, i2) > 3.001)
    i1, i2 = i1[ahead], i2[ahead]
    here = rows(i1, i2)
    if not np.isfinite(here).all():
        place = int(np.flatnonzero(~np.isfinite(here).all(axis=1))[0])
        message = f"returns values that are not finite numbers at I₁ = {i1[place]:.3f}, I₂ = {i2[place]:.3f}"
        low, high = stretch_range
        hint = f"it must be valid for stretches from {low:g} to {high:g} in both directions: give another stretch_range"
        raise fault("evaluate", message, hint)
    step1, step2 = 1e-5 * i1 / 3, 1e-5 * i2 / 3
    along1 = (rows(i1 + step1, i2) - rows(i1 - step1, i2)) / (2 * step1[:, None])
    along2 = (rows(i1, i2 + step2) - rows(i1, i2 - step2)) / (2 * step2[:, None])
    pairs = [
        ("d1", here[:, 1], along1[:, 0]),
        ("d2", here[:, 2], along2[:, 0]),
        ("d11", here[:, 3], along1[:, 1]),
        ("d12", here[:, 4], along1[:, 2]),
        ("d22", here[:, 5], along2[:, 2]),
    ]
    scale = np.abs(here[:, 1:3]).max(axis=1) + np.finfo(float).tiny
    for name, given, difference in pairs:
        error = np.abs(given - difference) / (1e-4 * scale + 1e-3 * np.abs(difference))
        worst = int(np.nan_to_num(error, nan=np.inf).argmax())
        if not error[worst] <= 1.0:
            raise fault(
                "evaluate",
                f"{name} is {given[worst]:g} at I₁ = {i1[worst]:.3f}, I₂ = {i2[worst]:.3f}, "
                f"and the finite difference that it must equal is {difference[worst]:g}",
                "the derivatives must be those of the energy within stretch_range",
            )
