"""Plates between two grips."""

from __future__ import annotations

from collections.abc import Sequence

from ._errors import fault
from ._material import Material
from ._material import material as _material
from ._quantities import PathLike, Quantity, text, toml, whole
from ._study import Factors, Settings, StudyInMemory, factor_texts, merged

__all__ = ["Plate"]


ARGUMENTS = {
    "kind": "use gelbench.run for studies of other kinds",
    "plate.length": "give it as length=",
    "plate.width": "give it as width=",
    "plate.thickness": "give it as thickness=",
    "plate.cells": "give them as cells=",
    "material.card": "give it as material=",
    "load.stretches": "give them as factors= of solve, run and study",
}
"""Settings that are arguments, and the remedy."""


class Plate(StudyInMemory):
    """A rectangular plate between two rigid grips, which clamp its short sides; the right one is moved along x.

    Parameters
    ----------
    length, width, thickness : quantity
        Dimensions at rest [mm].
    material : Material, str or path
        The material, or its card.
    cells : tuple of int
        Cells of the lattice along and across.
    settings : mapping, optional
        Other keys of a study, by section where they have one, such as ``{"title": "Gel", "corrector": {"scheme": "gauss"}}``;
        ``gelbench keys`` and the guide list them. Settings that are arguments are refused here.

    Attributes
    ----------
    length, width, thickness : float
        Dimensions at rest [mm]; quantities may be assigned.
    material : Material
        The material; another one, or its card, may be assigned.

    Raises
    ------
    gelbench.InputError
        With every fault, also when a dimension is assigned.

    Examples
    --------
    >>> plate = gb.Plate(length=150, width="5 cm", thickness=2, material="pva-10")
    >>> plate.solve(factors=["50 %"]).force
    12.874...
    """

    _section = "plate"
    STRETCHES = (0.15, 0.3, 0.5, 0.75, 1.0)
    """Stretches if none are given."""

    def __init__(
        self,
        length: Quantity = 150.0,
        width: Quantity = 50.0,
        thickness: Quantity = 2.0,
        material: Material | PathLike = "pva-10",
        *,
        cells: Sequence[int] = (60, 20),
        settings: Settings | None = None,
    ) -> None:
        self.material = _material(material)
        if isinstance(cells, (str, bytes)) or not hasattr(cells, "__iter__"):
            raise fault("cells", f"is {cells!r}", "give two numbers, such as (60, 20): along and across")
        own = {
            "length": text(length, "mm", "length"),
            "width": text(width, "mm", "width"),
            "thickness": text(thickness, "mm", "thickness"),
            "cells": [whole(count, "cells", 1) for count in cells],
        }
        self._sections = merged({"plate": own}, settings, ARGUMENTS)
        self._check()

    def _text(self, factors: Factors | None, card: str) -> str:
        load = {"stretches": factor_texts(factors, self.STRETCHES)}
        return toml(merged({"kind": "plate", "material": {"card": card}, "load": load}, self._sections))

    def __repr__(self) -> str:
        own = self._sections["plate"]
        return f"<gelbench.Plate {own['length']} × {own['width']} × {own['thickness']}, {self.material.name}>"
