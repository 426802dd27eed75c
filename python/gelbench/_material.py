"""Materials: cards, and laws written in Python."""

from __future__ import annotations

import html
import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import PerformanceWarning, fault
from ._quantities import Floats, PathLike, Quantity, number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Derivatives", "Material", "Parameter", "laws", "materials"]


class Parameter(NamedTuple):
    """A parameter of a material."""

    value: float
    """Its value in `unit`."""
    unit: str
    """``MPa``, or ``–`` for a plain number."""


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


def materials() -> dict[str, str]:
    """The cards that come along.

    Returns
    -------
    dict
        Titles by names.
    """
    return dict(_core.materials())


def laws() -> dict[str, str]:
    """The laws that cards and fits may name.

    Returns
    -------
    dict
        Energies by names.
    """
    return dict(_core.laws())


class Material:
    """A hyperelastic material of a thin sheet: a law with its parameters, and where they come from.

    Make one with `from_card`, `from_text` or `from_law`; `gelbench.fit` makes one of test data.
    """

    __slots__ = ("_card", "_reference")

    def __init__(self, card: _core.MaterialCard, reference: str | None = None) -> None:
        self._card = card
        self._reference = reference

    @classmethod
    def from_card(cls, card: PathLike) -> Material:
        """Reads a card.

        Parameters
        ----------
        card : str or path
            The name of a card that comes along (see `gelbench.materials`), or the path of a ``.toml`` file.

        Raises
        ------
        gelbench.InputError
            With every fault of the card.
        """
        name = os.fspath(card)
        own = _core.MaterialCard.load(name, ".")
        return cls(own, name if name in materials() else str(Path(name).resolve()))

    @classmethod
    def from_text(cls, text: str, name: str = "card") -> Material:
        """Reads the text of a card.

        Raises
        ------
        gelbench.InputError
            With every fault of the card.
        """
        return cls(_core.MaterialCard.parse(name, text))

    @classmethod
    def from_law(
        cls,
        evaluate: Law,
        *,
        name: str = "a law in Python",
        stretch_range: tuple[float, float] = (0.5, 3.0),
        quiet: bool = False,
    ) -> Material:
        """Makes a material of a law Ψ(I₁, I₂) that is written in Python.

        The sheet keeps its volume, and is in plane stress. The derivatives are compared with differences of the energy
        before the law is taken.

        Parameters
        ----------
        evaluate : callable
            Takes two arrays of one shape, I₁ and I₂, and returns `Derivatives`. It is called from several threads, one at a
            time.
        name : str
            For messages.
        stretch_range : tuple of float
            The stretches within which the law is trusted.
        quiet : bool
            Whether to leave out the warning that such a law is slow.

        Warns
        -----
        gelbench.PerformanceWarning
            Laws in Python are many times slower than those of gelbench.

        Raises
        ------
        gelbench.InputError
            Where the derivatives are not those of the energy, or have a wrong shape.
        """

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

        _check_derivatives(rows)
        if not quiet:
            warnings.warn(
                f"{name} is evaluated in Python: models are many times slower with it than with a law of gelbench",
                PerformanceWarning,
                stacklevel=2,
            )
        return cls(_core.MaterialCard.of_python(name, rows, list(stretch_range)))

    def with_parameters(self, **values: Quantity) -> Material:
        """The same law with other values of some parameters.

        Parameters
        ----------
        **values : quantity
            Parameters by key; plain numbers are MPa, or plain where the parameter is.

        Raises
        ------
        gelbench.InputError
            Where the law has no such parameter, or is none of gelbench's.
        """
        units = {key: own.unit for key, own in self.parameters.items()}
        given = {
            key: number(value, "MPa" if units.get(key, "MPa") == "MPa" else "", key) for key, value in values.items()
        }
        return Material(self._card.with_parameters(given))

    @property
    def name(self) -> str:
        """Name of the card."""
        return self._card.name

    @property
    def title(self) -> str:
        """One line about it."""
        return self._card.title

    @property
    def law(self) -> str:
        """Name of the law."""
        return self._card.law

    @property
    def formula(self) -> str:
        """Energy of the law."""
        return self._card.formula

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Parameters by their keys."""
        return {key: Parameter(value, unit) for key, value, unit in self._card.parameters()}

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus [MPa]."""
        return self._card.shear_modulus()

    @property
    def youngs_modulus(self) -> float:
        """Initial Young's modulus [MPa]."""
        return self._card.youngs_modulus()

    @property
    def stretch_range(self) -> tuple[float, float]:
        """The stretches within which it was calibrated."""
        return self._card.stretch_range

    @property
    def density(self) -> float | None:
        """Mass density [tonne/mm³], where the card says it."""
        return self._card.density

    @property
    def citation(self) -> str:
        """Where the card comes from."""
        return self._card.citation

    @property
    def doi(self) -> str:
        """DOI of the source; empty where there is none."""
        return self._card.doi

    @property
    def note(self) -> str:
        """What a user must know; may be empty."""
        return self._card.note

    @property
    def text(self) -> str:
        """Text of the card; empty for a law in Python."""
        return self._card.text

    def stable_range(self, test: str = "uniaxial") -> tuple[float, float]:
        """The stretches between which the material is stable in a test.

        Parameters
        ----------
        test : {"uniaxial", "planar", "equibiaxial"}
            The test.
        """
        return self._card.stable_range(test)

    def stress(self, stretch: ArrayLike, test: str = "uniaxial") -> Floats:
        """Nominal stress of a test.

        Parameters
        ----------
        stretch : array_like
            λ, positive; 1 + γ for ``test="shear"``. Any shape.
        test : {"uniaxial", "planar", "equibiaxial", "shear"}
            The test.

        Returns
        -------
        numpy.ndarray
            P₁₁ [MPa], P₁₂ of shear, in the shape of `stretch`; NaN where `stretch` is.

        Raises
        ------
        gelbench.InputError
            Where a stretch is not positive, or the test is unknown.
        """
        try:
            array = np.asarray(stretch, dtype=np.float64)
        except (TypeError, ValueError):
            raise fault("stretch", "is no array of numbers", "give floats") from None
        if test != "shear" and (array <= 0.0).any():
            raise fault("stretch", f"holds {array.min()}", "stretches are positive; 1 is the state at rest")
        found = self._card.stress(test, np.ascontiguousarray(array).reshape(-1))
        return found.reshape(array.shape)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        tests: tuple[str, ...] = ("uniaxial", "planar", "equibiaxial"),
        stretch: ArrayLike | None = None,
    ) -> Axes:
        """Draws the curves of tests.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        tests : tuple of str
            The tests.
        stretch : array_like, optional
            The stretches; those of the card by default.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from ._plots import material_curves

        return material_curves(self, ax, tests, stretch)

    def save(self, path: PathLike) -> None:
        """Writes the card into a file."""
        if not self.text:
            raise fault("material", "a law in Python has no card", "save its code")
        Path(path).write_text(self.text, encoding="utf-8")

    def __repr__(self) -> str:
        numbers = ", ".join(f"{key}={own.value:g}" for key, own in self.parameters.items())
        return f"<gelbench.Material {self.name}: {self.law}{f' ({numbers})' if numbers else ''}>"

    def _repr_html_(self) -> str:
        from ._plots import inline

        rows = "".join(
            f"<tr><td>{html.escape(key)}</td><td>{own.value:g} {html.escape(own.unit.strip('–'))}</td></tr>"
            for key, own in self.parameters.items()
        )
        head = f"<b>{html.escape(self.title)}</b><br>{html.escape(self.law)}: {html.escape(self.formula)}"
        return f"{head}<table>{rows}</table>{inline(lambda ax: self.plot(ax))}"

    def __reduce__(self) -> tuple[Any, ...]:
        if not self.text:
            raise TypeError("a law in Python cannot be pickled")
        return (_of_text, (self.text, self.name, self._reference))


def _of_text(text: str, name: str, reference: str | None) -> Material:
    return Material(_core.MaterialCard.parse(name, text), reference)


def material(value: Material | PathLike) -> Material:
    """A material, or that of a card."""
    return value if isinstance(value, Material) else Material.from_card(value)


def reference(value: Material) -> str:
    """The card that a study's text names; the one given takes its place where it has no name of its own."""
    return value._reference or "pva-10"


def card(value: Material) -> _core.MaterialCard:
    """The card of a material."""
    return value._card


def _check_derivatives(rows: Callable[[Floats, Floats], Floats]) -> None:
    """Compares the derivatives of a law with differences, at states of uniaxial and equibiaxial stretch."""
    stretch = np.array([0.8, 1.1, 1.3, 1.6])
    one, two = stretch**2 + 2 / stretch, 2 * stretch + stretch**-2
    i1, i2 = np.concatenate([one, two]), np.concatenate([two, one])
    step = 1e-5
    here = rows(i1, i2)
    if not np.isfinite(here).all():
        raise fault("evaluate", "returns values that are no numbers", "it must hold for stretches from 0.8 to 1.6")
    along1 = (rows(i1 + step, i2) - rows(i1 - step, i2)) / (2 * step)
    along2 = (rows(i1, i2 + step) - rows(i1, i2 - step)) / (2 * step)
    pairs = [
        ("d1", here[:, 1], along1[:, 0]),
        ("d2", here[:, 2], along2[:, 0]),
        ("d11", here[:, 3], along1[:, 1]),
        ("d12", here[:, 4], along1[:, 2]),
        ("d22", here[:, 5], along2[:, 2]),
    ]
    scale = max(float(np.abs(here[:, 1:3]).max()), np.finfo(float).tiny)
    for name, given, difference in pairs:
        error = np.abs(given - difference)
        if (error > 1e-4 * scale + 1e-3 * np.abs(difference)).any():
            worst = int(error.argmax())
            raise fault(
                "evaluate",
                f"{name} is {given[worst]:g} at I₁ = {i1[worst]:.3f}, I₂ = {i2[worst]:.3f}, "
                f"and the difference of what it derives is {difference[worst]:g}",
                "the derivatives must be those of the energy",
            )
