"""Materials: cards, and laws written in Python."""

from __future__ import annotations

import html
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._energy import Energy, card_of
from ._errors import InputError, WriteError, fault
from ._plots import inline, material_curves
from ._quantities import Floats, PathLike, Quantity, array_of, text, texts, toml

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Material", "Parameter", "laws", "materials"]


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


def viscosity_sections(viscosity: Mapping[str, Any] | None, name: str) -> dict[str, Any]:
    """The sections of a viscosity; plain numbers are MPa·s and s."""
    viscous = texts(viscosity or {}, {"shear": "MPa*s"}, "viscosity")
    relaxation = viscous.pop("relaxation", [])
    terms = [texts(term, {"time": "s"}, "viscosity.relaxation") for term in ([relaxation] if isinstance(relaxation, Mapping) else relaxation)]
    return {name: viscous} | ({f"{name}.relaxation": terms} if terms else {})


class Material:
    """A hyperelastic material of a thin sheet: a law with its parameters, and where they come from.

    `from_card`, `from_text` and `from_energy` create one too, and `gelbench.fit` from test data. Materials are equal if the texts of their
    cards are.

    Parameters
    ----------
    law : str
        Name of a law, see `gelbench.laws`.
    name : str, optional
        Name of the material; that of the law if omitted.
    **values : quantity
        Parameters of the law [MPa, rad, –], or ``youngs_modulus``, ``shear_modulus``, ``bulk_modulus`` [MPa] and ``poisson_ratio`` instead of
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
    def from_energy(cls, energy: Energy, *, name: str = "energy", stretch_range: tuple[float, float] = (0.5, 3.0)) -> Material:
        """Creates a material from its energy Ψ in MPa = mJ/mm³, which the library differentiates.

        The function is called once, with variables in place of numbers, and becomes the formula of a card: it is computed as a law of
        gelbench, in studies and sweeps too. The sheet is incompressible.

        Parameters
        ----------
        energy : callable
            ``lambda i1, i2: …`` of the invariants, ``lambda C: …`` of the right Cauchy-Green tensor or ``lambda F: …`` of the
            deformation gradient, both 3 × 3 in the axes of the sheet, with NumPy's functions.
        name : str
            Name of the material.
        stretch_range : tuple of float
            The smallest and the largest stretch for which the law is valid.

        Raises
        ------
        gelbench.InputError
            If the energy is no formula, is not zero at rest, leaves a stress there, changes with a rotation, has no positive shear modulus, or
            is not defined within `stretch_range`.

        Examples
        --------
        >>> gb.Material.from_energy(lambda i1, i2: 0.03 * (i1 - 3) + 0.004 * (i1 - 3) ** 2)
        <gelbench.Material energy: energy>
        """
        made = cls.from_text(card_of(energy, name, stretch_range), name)
        ends = np.array(stretch_range, dtype=float)
        for test in ("uniaxial", "equibiaxial"):
            undefined = ends[~np.isfinite(made.stress(ends, test))]
            if undefined.size:
                message = f"has no {test} stress at a stretch of {undefined[0]:g}"
                raise fault("energy", message, "give another stretch_range, within which it is defined")
        return made

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

    def with_properties(
        self,
        *,
        density: Quantity | None = None,
        viscosity: Mapping[str, Any] | None = None,
        softening: Mapping[str, Any] | None = None,
        volume: Mapping[str, Any] | None = None,
    ) -> Material:
        """The same law with more of the material's behaviour, as sections of its card.

        Parameters
        ----------
        density : quantity
            Such as ``"1020 kg/m^3"``.
        viscosity : mapping
            ``{"shear": "50 Pa*s"}``, ``{"relaxation": [{"share": 0.3, "time": "2 s"}]}``, or both: what motions dissipate.
        softening : mapping
            Mullins softening of Ogden and Roxburgh: ``{"r": 2.0, "m": "0.02 MPa", "beta": 0.1}``.
        volume : mapping
            Resistance to a change of volume: ``{"poisson_ratio": 0.45}`` or ``{"bulk_modulus": "1 MPa"}``. Plane strain needs it:
            ``settings={"material": {"sheet": "plane-strain"}}`` of a plate or a specimen.

        Raises
        ------
        gelbench.InputError
            With every fault, and where the card states such a property already.
        """
        sections: dict[str, Any] = {
            "softening": texts(softening or {}, {"m": "MPa"}, "softening"),
            "volume": texts(volume or {}, {"bulk_modulus": "MPa"}, "volume"),
            **viscosity_sections(viscosity, "viscosity"),
        }
        added = toml(sections)
        stated = [name for name in ("softening", "volume", "viscosity") if f"[{name}" in added and re.search(rf"(?m)^\[+{name}\b", self.text)]
        if stated:
            raise fault(stated[0], f"is stated by the card `{self.name}`", "change it in the card's text")
        text_ = self.text
        if density is not None:
            line = f"density = {text(density, 'kg/m^3', 'density')!r}\n"
            text_ = line + re.sub(r"(?m)^density *=.*\n", "", text_)
        return Material.from_text(f"{text_.rstrip()}\n{added}", self.name)

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
    def swelling_stretch(self) -> float:
        """Length of the freely swollen gel, which is at rest here, over that as prepared; 1 for laws without swelling."""
        return self._card.swelling_stretch()

    @property
    def stretch_range(self) -> tuple[float, float]:
        """The range of stretches of its calibration; (0.5, 3) of a material that was not calibrated."""
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
        """Text of the card."""
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
        return material_curves(self, ax, tests, stretch)

    def save(self, path: PathLike) -> None:
        """Writes the card into a file.

        Raises
        ------
        gelbench.WriteError
            If the file cannot be written.
        """
        try:
            Path(path).write_text(self.text, encoding="utf-8")
        except OSError as cause:
            raise WriteError(f"{path} cannot be written: {cause}") from cause

    def __repr__(self) -> str:
        numbers = ", ".join(f"{key}={own.value:g}" for key, own in self.parameters.items())
        return f"<gelbench.Material {self.name}: {self.law}{f' ({numbers})' if numbers else ''}>"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{html.escape(key)}</td><td>{own.value:g} {html.escape(own.unit.strip('–'))}</td></tr>"
            for key, own in self.parameters.items()
        )
        head = f"<b>{html.escape(self.title)}</b><br>{html.escape(self.law)}: {html.escape(self.formula)}"
        return f"{head}<table>{rows}</table>{inline(lambda ax: self.plot(ax))}"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Material):
            return NotImplemented
        return self.text == other.text

    def __hash__(self) -> int:
        return hash(self.text)

    def __reduce__(self) -> tuple[Any, ...]:
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
    return name, {name: value.text.encode()}


def on_disk(value: Material) -> str:
    """The card named in a study's text that is computed elsewhere."""
    name = shipped(value) or value._reference
    if name is None:
        hint = 'use write_study("plate.toml"), which writes the card beside the study, or save the material and give its file as card='
        raise fault("material", f"the card `{value.name}` is not in a file that a study can name", hint)
    if shipped(value) is None and not _is_as_read(value):
        raise fault("material", f"{name} has changed since it was read", "read it again, or use write_study, which writes the card as it was read")
    return name


def _is_as_read(value: Material) -> bool:
    try:
        return _core.text_of_file(value._reference or "") == value.text
    except InputError:
        return False


def card(value: Material) -> _core.MaterialCard:
    """The card of a material."""
    return value._card
