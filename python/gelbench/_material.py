"""Materials: cards, and laws written in Python."""

from __future__ import annotations

import html
import os
import re
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import InputError, PerformanceWarning, WriteError, fault
from ._law import Derivatives, Law, card_in_place, checked_range, rows_of
from ._quantities import Floats, PathLike, Quantity, array_of, text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Derivatives", "Material", "Parameter", "laws", "materials"]


class Parameter(NamedTuple):
    """A parameter of a material."""

    value: float
    """Its value in `unit`."""
    unit: str
    """``MPa``, or ``–`` for a plain number."""


def materials() -> dict[str, str]:
    """The shipped cards.

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

    `from_card`, `from_text` and `from_law` create one too, and `gelbench.fit` from test data. Materials are equal if the texts of their
    cards are.

    Parameters
    ----------
    law : str
        Name of a law, see `gelbench.laws`.
    name : str, optional
        Name of the material; that of the law if omitted.
    **values : quantity
        Parameters of the law [MPa, –], or ``youngs_modulus``, ``shear_modulus``, ``bulk_modulus`` [MPa] and ``poisson_ratio`` instead of
        one; ``density``, such as ``"1020 kg/m^3"``; ``convention`` of Ogden's law.

    Raises
    ------
    gelbench.InputError
        With every fault.

    Examples
    --------
    >>> gb.Material("gent", mu=0.05, jm=30)
    <gelbench.Material gent: gent (mu=0.05, jm=30)>
    """

    __slots__ = ("_card", "_reference")

    def __init__(self, law: str, *, name: str | None = None, **values: Quantity) -> None:
        given = {key: text(value, "", key) for key, value in values.items()}
        self._card = _core.MaterialCard.of_law(law, name or law, given)
        self._reference: str | None = None

    @classmethod
    def _of(cls, card: _core.MaterialCard, reference: str | None = None) -> Material:
        made = cls.__new__(cls)
        made._card, made._reference = card, reference
        return made

    @classmethod
    def from_card(cls, card: PathLike) -> Material:
        """Reads a card.

        Parameters
        ----------
        card : str or path
            The name of a shipped card (see `gelbench.materials`), or the path of a ``.toml`` file, which is read once.

        Raises
        ------
        gelbench.InputError
            With every fault of the card.
        """
        try:
            name = os.fspath(card)
        except TypeError:
            raise fault("material", f"{card!r} is not a card", "give a Material, the name of a card, or the path of one") from None
        own = _core.MaterialCard.load(name, ".")
        return cls._of(own, name if name in materials() else str(Path(name).resolve()))

    @classmethod
    def from_text(cls, text: str, name: str = "card") -> Material:
        """Reads the text of a card.

        Raises
        ------
        gelbench.InputError
            With every fault of the card.
        """
        return cls._of(_core.MaterialCard.parse(name, text))

    @classmethod
    def from_law(
        cls,
        evaluate: Law,
        *,
        name: str = "a law in Python",
        stretch_range: tuple[float, float] = (0.5, 3.0),
        quiet: bool = False,
    ) -> Material:
        """Creates a material from a law Ψ(I₁, I₂) written in Python.

        The sheet is incompressible and in plane stress. Before the law is accepted, the derivatives are compared with
        finite differences of the energy wherever both in-plane stretches are within `stretch_range`.

        Parameters
        ----------
        evaluate : callable
            Takes two arrays of one shape, I₁ and I₂, and returns `Derivatives`. It is called from several threads, one at a
            time.
        name : str
            For messages.
        stretch_range : tuple of float
            The smallest and the largest stretch for which the law is valid.
        quiet : bool
            Whether to suppress the warning that such a law is slow.

        Warns
        -----
        gelbench.PerformanceWarning
            Laws in Python are many times slower than those of gelbench.

        Raises
        ------
        gelbench.InputError
            If the derivatives are not those of the energy or have a wrong shape, the energy at rest is not zero, the shear
            modulus is not positive, or `stretch_range` is invalid.
        """

        within = checked_range(stretch_range)
        rows = rows_of(evaluate, within)
        if not quiet:
            warnings.warn(
                f"{name} is evaluated in Python: models are many times slower with it than with a law of gelbench",
                PerformanceWarning,
                stacklevel=2,
            )
        return cls._of(_core.MaterialCard.of_python(name, rows, list(within)))

    def with_parameters(self, **values: Quantity) -> Material:
        """The same law with other values of some parameters.

        Parameters
        ----------
        **values : quantity
            Parameters by key; plain numbers are in the unit that `parameters` has.

        Returns
        -------
        Material
            With a card of its own, whose citation names the card that it was made from; without source, quality and record of a fit.

        Raises
        ------
        gelbench.InputError
            If the law has no such parameter or is not one of gelbench's.
        """
        units = {key: own.unit.strip("–") for key, own in self.parameters.items()}
        return Material._of(self._card.with_parameters({key: text(value, units.get(key, ""), key) for key, value in values.items()}))

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
        """The range of stretches of its calibration."""
        return self._card.stretch_range

    @property
    def density(self) -> float | None:
        """Mass density [tonne/mm³], if the card states it."""
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
        """Remarks on the use of the card; may be empty."""
        return self._card.note

    @property
    def text(self) -> str:
        """Text of the card; empty for a law in Python."""
        return self._card.text

    def stable_range(self, test: str = "uniaxial") -> tuple[float, float]:
        """The range of stretches in which the material is stable in a test.

        Parameters
        ----------
        test : {"uniaxial", "planar", "equibiaxial"}
            The test.
        """
        return self._card.stable_range(test)

    @overload
    def stress(self, stretch: float, test: str = "uniaxial") -> float: ...
    @overload
    def stress(self, stretch: ArrayLike, test: str = "uniaxial") -> Any: ...
    def stress(self, stretch: ArrayLike, test: str = "uniaxial") -> Any:
        """Nominal stress of a test.

        Parameters
        ----------
        stretch : array_like
            λ, positive; 1 + γ for ``test="shear"``. Any shape; quantities of pint may be in percent.
        test : {"uniaxial", "planar", "equibiaxial", "shear"}
            The test.

        Returns
        -------
        numpy.ndarray or float
            P₁₁ [MPa], P₁₂ of shear, in the shape of `stretch`; NaN where `stretch` is NaN.

        Raises
        ------
        gelbench.InputError
            If a stretch is not positive or is masked, or the test is unknown.
        """
        array = array_of(stretch, "stretch")
        if test != "shear" and (array <= 0.0).any():
            raise fault("stretch", f"holds {array.min()}", "stretches are positive; 1 is the state at rest")
        found = self._card.stress(test, np.ascontiguousarray(array).reshape(-1))
        return found.reshape(array.shape) if array.ndim else float(found[0])

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
        """Writes the card into a file.

        Raises
        ------
        gelbench.InputError
            If there is no card because the material is a law in Python.
        gelbench.WriteError
            If the file cannot be written.
        """
        if not self.text:
            raise fault("material", "a law in Python has no card", "save its code")
        try:
            Path(path).write_text(self.text, encoding="utf-8")
        except OSError as cause:
            raise WriteError(f"{path} cannot be written: {cause}") from cause

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

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Material):
            return NotImplemented
        return self._card is other._card or (bool(self.text) and self.text == other.text)

    def __hash__(self) -> int:
        return hash(self.text or self._card)

    def __reduce__(self) -> tuple[Any, ...]:
        if not self.text:
            raise TypeError("a law in Python cannot be pickled: create it again from its code")
        return (_of_text, (self.text, self.name, self._reference))


def _of_text(text: str, name: str, reference: str | None) -> Material:
    return Material._of(_core.MaterialCard.parse(name, text), reference)


def material(value: Material | PathLike) -> Material:
    """A material, or that of a card."""
    return value if isinstance(value, Material) else Material.from_card(value)


def shipped(value: Material) -> str | None:
    """The name of a shipped card."""
    return None if value._reference is None or value._reference.endswith(".toml") else value._reference


def in_memory(value: Material) -> tuple[str, dict[str, bytes]]:
    """The card named in a study's text that is computed here, and the files that this name stands for."""
    name = shipped(value)
    if name is not None:
        return name, {}
    name = value._reference or re.sub(r"[^\w.-]+", "-", value.name).strip(".") + ".toml"
    own = value.text or card_in_place(value.name, value.shear_modulus, value.stretch_range)
    return name, {name: own.encode()}


def on_disk(value: Material) -> str:
    """The card named in a study's text that is computed elsewhere."""
    name = shipped(value) or value._reference
    if name is None:
        hint = 'use write_study("plate.toml"), which writes the card beside the study, or save the material and give its file as card='
        raise fault("material", f"the card `{value.name}` is not in a file that a study can name", needs_card(value) or hint)
    if shipped(value) is None and not _is_as_read(value):
        raise fault("material", f"{name} has changed since it was read", "read it again, or use write_study, which writes the card as it was read")
    return name


def needs_card(value: Material) -> str | None:
    """The remedy if the material cannot be written to a file."""
    return None if value.text else "a study cannot name a law in Python: use a law of gelbench, or solve it here"


def _is_as_read(value: Material) -> bool:
    try:
        return _core.text_of_file(value._reference or "") == value.text
    except InputError:
        return False


def card(value: Material) -> _core.MaterialCard:
    """The card of a material."""
    return value._card
