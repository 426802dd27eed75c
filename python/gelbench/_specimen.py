"""Specimens of any shape."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import fault
from ._fields import NUMBERS, read_mesh
from ._material import Material
from ._material import material as _material
from ._quantities import PathLike, Quantity, array_of, floats, refuse_masked, text, toml, whole
from ._study import Factors, Settings, StudyInMemory, factor_texts, merged

__all__ = ["Condition", "Specimen"]

Condition: TypeAlias = "str | Mapping[str, Any]"
"""How a group is supported or loaded: a kind, or its keys, such as ``{"x": "45 mm", "y": 0}``."""

UNITS = {
    "x": "mm",
    "y": "mm",
    "displacement": "mm",
    "x_force": "N",
    "y_force": "N",
    "angle": "rad",
    "pressure": "MPa",
}
"""Units of plain numbers in supports and loads."""

LOADS = {"traction": "MPa", "force": "N"}
"""Units of x and y in loads."""

MEASURES = (
    "length",
    "width",
    "hole_diameter",
    "notch_depth",
    "notch_length",
    "narrow_length",
    "narrow_width",
    "shoulder_length",
    "inner_radius",
    "outer_radius",
    "angle",
    "tines",
    "tine_spacing",
    "tine_inset",
    "tine_diameter",
    "arm_width",
    "fillet",
)

ARGUMENTS = {
    "kind": "use gelbench.run for studies of other kinds",
    "specimen.shape": "give it as the first argument",
    "specimen.thickness": "give it as thickness=",
    "specimen.cells": "give them as cells=",
    "specimen.lattice": "give it as lattice=",
    "specimen.file": "give the mesh to Specimen.from_mesh",
    "specimen.file_unit": "give it as unit= of Specimen.from_mesh",
    **{f"specimen.{name}": f"give it as {name}=" for name in MEASURES},
    "material.card": "give it as material=",
    "path.factors": "give them as factors= of solve, run and study",
    "path.measured_group": "give it as measured=",
    "support": "give them as supports=",
    "load": "give them as loads=",
}
"""Settings that are arguments, and the remedy."""


class Specimen(StudyInMemory):
    """A sheet of any shape, with supports and loads on its sides.

    Parameters
    ----------
    shape : {"strip", "strip-with-hole", "notched-strip", "dog-bone", "ring-sector", "square-on-rakes", "cruciform"}
        The shape; `Specimen.from_mesh` takes any.
    thickness : quantity
        Thickness at rest [mm].
    material : Material, str or path
        The material, or its card.
    supports : mapping
        Supports of groups, by name: ``"clamp"``, ``"roller"``, ``"symmetry"``, or keys such as ``{"x": 45, "y": 0}`` and
        ``{"kind": "grip", "x_force": 3, "y": 0}``. Plain numbers are mm, N and rad. Several for one group form a list.
    loads : mapping, optional
        Loads on groups: ``{"kind": "force", "x": 3}`` [N], ``{"kind": "traction", "y": 0.01}`` [MPa],
        ``{"kind": "pressure", "pressure": 0.01}`` [MPa].
    measured : str
        The group whose force is measured.
    cells : int
        Cells of the lattice across.
    lattice : {"quadrilaterals", "triangles"}
        Cells of the lattice.
    settings : mapping, optional
        Other keys of a study, by section where they have one, such as ``{"finite_element": {"element": "T2"}}``. Settings
        that are arguments are refused here.
    **measures : quantity
        Measures of the shape [mm]: ``length``, ``width``, ``hole_diameter``, ``notch_depth``, ``notch_length``,
        ``narrow_length``, ``narrow_width``, ``shoulder_length``, ``inner_radius``, ``outer_radius``; ``angle`` [rad]; of a square on rakes
        ``tine_spacing``, ``tine_inset``, ``tine_diameter`` and the number of ``tines`` at each side; of a cruciform ``arm_width``, ``fillet``.

    Attributes
    ----------
    thickness and all measures that are stated : float
        Dimensions at rest [mm, rad]; quantities may be assigned.
    material : Material
        The material; another one, or its card, may be assigned.

    Raises
    ------
    gelbench.InputError
        With every fault, also when a dimension is assigned.

    Examples
    --------
    >>> strip = gb.Specimen(
    ...     "strip-with-hole", length=90, width=30, hole_diameter=12, thickness=2, material="pva-10",
    ...     supports={"left": "clamp", "right": {"x": 45, "y": 0}}, measured="right")
    >>> strip.solve("finite-element").force
    """

    _section = "specimen"
    FACTORS = (1.0,)
    """Load factors if none are given."""

    def __init__(
        self,
        shape: str,
        *,
        thickness: Quantity,
        material: Material | PathLike,
        supports: Mapping[str, Condition | Sequence[Condition]],
        measured: str,
        loads: Mapping[str, Condition | Sequence[Condition]] | None = None,
        cells: int = 24,
        lattice: str = "quadrilaterals",
        settings: Settings | None = None,
        **measures: Quantity,
    ) -> None:
        unknown = [name for name in measures if name not in MEASURES]
        if unknown:
            raise fault(unknown[0], "is not a dimension of a shape", f"measures are {', '.join(MEASURES)}")
        def measure(name: str, value: Quantity) -> str | int:
            if name == "tines":
                return whole(value, "tines", 1)
            return text(value, "rad" if name == "angle" else "mm", name)

        own = {name: measure(name, value) for name, value in measures.items()}
        specimen = {"shape": shape, **own, "cells": whole(cells, "cells", 1), "lattice": lattice}
        self._set(specimen, None, thickness, material, supports, measured, loads, settings)

    @classmethod
    def from_mesh(
        cls,
        points: Any,
        cells: Mapping[str, ArrayLike] | None = None,
        groups: Mapping[str, ArrayLike] | None = None,
        *,
        thickness: Quantity,
        material: Material | PathLike,
        supports: Mapping[str, Condition | Sequence[Condition]],
        measured: str,
        loads: Mapping[str, Condition | Sequence[Condition]] | None = None,
        unit: str = "mm",
        merge_nodes: Quantity | None = None,
        allowed: Sequence[str] = (),
        settings: Settings | None = None,
    ) -> Specimen:
        """A specimen on a mesh.

        Parameters
        ----------
        points : array_like, path, meshio.Mesh, pyvista.UnstructuredGrid or the module gmsh with its model
            Nodes, n × 2 or n × 3 with one z; or a whole mesh, whose named sets of nodes and lines are groups.
        cells : mapping, optional
            Nodes of the cells, m × k, counted from 0, by kind: ``triangle``, ``triangle6``, ``quad``, ``quad8``, ``quad9``.
        groups : mapping, optional
            Groups by name: numbers of nodes (n), or both ends of each line (n × 2). ``left``, ``right``, ``bottom``, ``top`` and
            ``boundary`` exist automatically.
        unit : str
            Unit of the points.
        merge_nodes : quantity, optional
            Nodes no farther apart than this are merged [mm].
        allowed : sequence of {"seams", "parts", "hinges", "polygons"}
            Apparent faults of the mesh that are intended.
        thickness, material, supports, measured, loads, settings
            As of `Specimen`.

        Notes
        -----
        Nodes without a cell are left out: fields have the order of `Solution.points`.
        """
        specimen: dict[str, Any] = {"shape": "mesh", "file": "the mesh", "file_unit": unit}
        if merge_nodes is not None:
            specimen["merge_nodes"] = text(merge_nodes, "mm", "merge_nodes")
        if allowed:
            specimen["allowed"] = list(allowed)
        made = cls.__new__(cls)
        if isinstance(points, (str, os.PathLike)):
            specimen["file"] = os.path.abspath(points)
            made._set(specimen, None, thickness, material, supports, measured, loads, settings)
            return made
        nodes: dict[str, Any] = {}
        lines: dict[str, Any] = {}
        own: Any = cells
        if cells is None:
            points, own, nodes, lines = read_mesh(points)
        kinds = {name: block for name, block in own.items() if name not in ("vertex", "line", "line3")}
        unknown = [name for name in kinds if name not in NUMBERS]
        if unknown:
            raise fault("cells", f"cells `{unknown[0]}` are not known", f"take {', '.join(list(NUMBERS)[2:])}")
        for name, group in (groups or {}).items():
            array = np.asarray(group)
            if array.ndim not in (1, 2) or (array.ndim == 2 and array.shape[1] != 2):
                raise fault("groups", f"`{name}` has the shape {array.shape}", "it must be n, nodes, or n × 2, lines")
            (nodes if array.ndim == 1 else lines)[name] = array
        places = array_of(points, "points", unit)
        if places.ndim == 2 and places.shape[1] == 2:
            places = np.column_stack([places, np.zeros(len(places))])
        mesh = (
            floats(places, "points", (None, 3)),
            [(NUMBERS[name], _integers(block, "cells", 2)) for name, block in kinds.items()],
            {name: _integers(group, "groups", 1) for name, group in nodes.items()},
            {name: _integers(group, "groups", 2) for name, group in lines.items()},
        )
        made._set(specimen, mesh, thickness, material, supports, measured, loads, settings)
        return made

    def _set(
        self,
        specimen: dict[str, Any],
        mesh: tuple[Any, ...] | None,
        thickness: Quantity,
        material: Material | PathLike,
        supports: Mapping[str, Any],
        measured: str,
        loads: Mapping[str, Any] | None,
        settings: Settings | None,
    ) -> None:
        self.material = _material(material)
        self._mesh_parts = mesh
        self._mesh = None if mesh is None else _core.GivenMesh(*mesh)
        own = {**specimen, "thickness": text(thickness, "mm", "thickness")}
        self._sections = merged({"specimen": own}, settings, ARGUMENTS)
        self._conditions = {"support": _entries(supports, "supports"), "load": _entries(loads or {}, "loads")}
        self._measured = measured
        self._check()

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_mesh": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._mesh = None if self._mesh_parts is None else _core.GivenMesh(*self._mesh_parts)

    def _text(self, factors: Factors | None, card: str) -> str:
        path = {"factors": factor_texts(factors, self.FACTORS), "measured_group": self._measured}
        conditions = {name: own for name, own in self._conditions.items() if own}
        own = merged({"kind": "specimen", "material": {"card": card}, "path": path}, self._sections)
        return toml({**own, **conditions})

    def __repr__(self) -> str:
        own = self._sections["specimen"]
        return f"<gelbench.Specimen {own['shape']}, {own['thickness']} thick, {self.material.name}>"


def _integers(values: Any, argument: str, dimensions: int) -> Any:
    refuse_masked(values, argument)
    array = np.asarray(values)
    if array.ndim != dimensions or not (np.issubdtype(array.dtype, np.integer) or array.size == 0):
        raise fault(argument, f"holds an array of {array.dtype} with the shape {array.shape}", "give numbers of nodes")
    return np.ascontiguousarray(array, dtype=np.int64)


def _entries(groups: Mapping[str, Any], argument: str) -> list[dict[str, Any]]:
    entries: list[dict[str, Any]] = []
    if not isinstance(groups, Mapping):
        raise fault(argument, f"is {groups!r}", 'give them by the names of groups, such as {"left": "clamp"}')
    for group, given in groups.items():
        for one in given if isinstance(given, (list, tuple)) else [given]:
            if not isinstance(one, (str, Mapping)):
                hint = 'give a kind, such as "clamp", or keys, such as {"x": 45, "y": 0}; leave out free components'
                raise fault(f"{argument}.{group}", f"is {one!r}", hint)
            own: dict[str, Any] = {"kind": one} if isinstance(one, str) else dict(one)
            kind = own.pop("kind", "displacement" if argument == "supports" else "force")
            entry = {"group": group, "kind": kind}
            for key, value in own.items():
                if key == "centre":
                    entry[key] = [text(part, "mm", f"{argument}.{key}") for part in value]
                elif key in ("x", "y") and argument == "loads":
                    entry[key] = text(value, LOADS.get(kind, "N"), f"{argument}.{key}")
                else:
                    entry[key] = text(value, UNITS.get(key, ""), f"{argument}.{key}")
            entries.append(entry)
    return entries
