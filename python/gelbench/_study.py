"""Plates and specimens: the problem as a study, solved by one model or compared in all three."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import SolveError, fault
from ._fields import NUMBERS, read_mesh
from ._material import Material, card, material, reference
from ._progress import Progress, callback
from ._quantities import PathLike, Quantity, finite, floats, number, text, toml
from ._results import Results
from ._solution import Solution

__all__ = ["Condition", "Factors", "Model", "Plate", "Specimen"]

Model: TypeAlias = Literal["corrected", "mass-spring", "finite-element"]
Factors: TypeAlias = "ArrayLike | Sequence[float | str]"
Condition: TypeAlias = "str | Mapping[str, Any]"
"""How a group is held or loaded: a kind, or its keys, such as ``{"x": "45 mm", "y": 0}``."""

IN_MEMORY = "gelbench-card-in-memory.toml"
"""The card of a material that has no file, in the text of a study."""

Settings: TypeAlias = "Mapping[str, Mapping[str, Any]]"

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
"""Those of x and y in loads."""

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
)


class _Study:
    """A study that is solved."""

    material: Material
    _sections: dict[str, Any]
    _mesh: _core.GivenMesh | None = None

    def study(self, factors: Factors | None = None) -> str:
        """The text of the study, which the command runs too.

        Parameters
        ----------
        factors : array_like, optional
            As in `solve`.
        """
        return self._text(factors, self._sections)

    def _text(self, factors: Factors | None, sections: dict[str, Any]) -> str:
        raise NotImplementedError

    def _in_memory(self, factors: Factors | None) -> tuple[str, str, dict[str, bytes]]:
        """Name and text of the study, and the files that the text names and no disk has."""
        name, own = type(self).__name__.lower(), card(self.material)
        if self._mesh is not None:
            raise fault("study", "its mesh is on no disk", "save the mesh, and give a study that names the file")
        if self.material._reference is not None:
            return name, self.study(factors), {}
        if not own.text:
            raise fault("material", f"{own.name} is no card that a study can name", "take a card, or the material of a fit")
        sections = {**self._sections, "material": {**self._sections["material"], "card": IN_MEMORY}}
        return name, self._text(factors, sections), {IN_MEMORY: own.text.encode()}

    def _one(self, study: str, model: str, progress: Any, allow_large: bool) -> _core.Solution:
        raise NotImplementedError

    def _all(self, study: str, progress: Any, allow_large: bool) -> _core.Results:
        raise NotImplementedError

    def solve(
        self,
        model: Model = "corrected",
        factors: Factors | None = None,
        *,
        reference: bool = False,
        progress: Progress | None = None,
        allow_large: bool = False,
    ) -> Solution:
        """Solves one model.

        Parameters
        ----------
        model : {"corrected", "mass-spring", "finite-element"}
            The model. Finite elements are those of the finest mesh of the study.
        factors : array_like, optional
            Load factors, ascending; of a plate the displacement of the grip over the length: 0.5, or ``"50 %"``, is a stretch to
            150 %.
        reference : bool
            Whether to solve all models, so that `State.error` is known.
        progress : callable or tqdm bar, optional
            Is told each step in a line of text, from another thread.
        allow_large : bool
            Whether to let pass what needs more than a common machine has.

        Returns
        -------
        Solution
            One state for each load factor.

        Raises
        ------
        gelbench.InputError
            With every fault of the problem.
        gelbench.SolveError
            Where a load factor is not reached; its `solution` holds the others.

        Notes
        -----
        Other Python threads go on meanwhile, and Ctrl-C stops the computation.
        """
        study = self.study(factors)
        told = callback(progress)
        core = self._one(study, model, told, allow_large)
        errors = self._errors(study, model, told, allow_large) if reference else {}
        solution = Solution(core, model, errors)
        if core.ends:
            error = core.ends[0]
            if isinstance(error, SolveError):
                error.load_factor = next((one for one in self._wanted(study) if one not in core.factors()), None)
                error.solution = solution
            raise error
        return solution

    def run(
        self,
        factors: Factors | None = None,
        *,
        progress: Progress | None = None,
        allow_large: bool = False,
    ) -> Results:
        """Solves all three models and compares them, as the command does.

        Parameters
        ----------
        factors, progress, allow_large
            As in `solve`.

        Returns
        -------
        Results
            Figures, requirements, warnings, fields and pictures.
        """
        return Results(self._all(self.study(factors), callback(progress), allow_large))

    def _errors(self, study: str, model: str, told: Any, allow_large: bool) -> dict[float, dict[str, float]]:
        results = Results(self._all(study, told, allow_large))
        key = model.replace("-", "_")
        steps: list[dict[str, Any]] = results.json["steps"]
        found: dict[float, dict[str, float]] = {}
        for step in steps:
            own = step.get(key) or {}
            percents = {name: own[name] for name in own if name.endswith("_percent") and own[name] is not None}
            found[float(step["at"])] = percents
        return found

    def _wanted(self, study: str) -> list[float]:
        line = next(line for line in study.splitlines() if line.startswith(("stretches", "factors")))
        listed = line.partition("[")[2].rpartition("]")[0].split(",")
        return [number(one.strip().strip('"'), "", "factors") for one in listed]


def _factors(factors: Factors | None, default: Sequence[float]) -> list[str]:
    given: Any = default if factors is None else factors
    if isinstance(given, str) or np.ndim(given) == 0:
        given = [given]
    if not all(isinstance(one, str) for one in given):
        # A study takes either texts or numbers alone.
        plain = [number(one, "", "factors") if isinstance(one, str) else one for one in given]
        given = finite(floats(plain, "factors", (None,)), "factors")
    return [text(one, "", "factors") for one in given]


def _merged(sections: dict[str, Any], settings: Settings | None) -> dict[str, Any]:
    for name, own in (settings or {}).items():
        sections[name] = {**sections.get(name, {}), **own}
    return sections


class Plate(_Study):
    """A rectangular plate between two rigid grips, which clamp its short sides; the right one is moved along x.

    Parameters
    ----------
    length, width, thickness : quantity
        Measures at rest [mm].
    material : Material, str or path
        The material, or its card.
    cells : tuple of int
        Cells of the lattice along and across.
    settings : mapping, optional
        Other keys of a study by section, such as ``{"corrector": {"scheme": "gauss"}}``; ``gelbench keys`` and the guide list
        them.

    Examples
    --------
    >>> plate = gb.Plate(length=150, width="5 cm", thickness=2, material="pva-10")
    >>> plate.solve(factors=["50 %"]).force
    12.874...
    """

    STRETCHES = (0.15, 0.3, 0.5, 0.75, 1.0)
    """Stretches where none are given."""

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
        self._sections = _merged(
            {
                "plate": {
                    "length": text(length, "mm", "length"),
                    "width": text(width, "mm", "width"),
                    "thickness": text(thickness, "mm", "thickness"),
                    "cells": [int(count) for count in cells],
                },
                "material": {"card": reference(self.material)},
            },
            settings,
        )

    def _text(self, factors: Factors | None, sections: dict[str, Any]) -> str:
        load = {"stretches": _factors(factors, self.STRETCHES)}
        return toml({"kind": "plate", **sections, "load": {**sections.get("load", {}), **load}})

    def _one(self, study: str, model: str, progress: Any, allow_large: bool) -> _core.Solution:
        return _core.solve_plate(study, card(self.material), model, progress, allow_large)

    def _all(self, study: str, progress: Any, allow_large: bool) -> _core.Results:
        return _core.run_plate(study, card(self.material), progress, allow_large)

    def __repr__(self) -> str:
        own = self._sections["plate"]
        return f"<gelbench.Plate {own['length']} × {own['width']} × {own['thickness']}, {self.material.name}>"


def _material(value: Material | PathLike) -> Material:
    return material(value)


class Specimen(_Study):
    """A sheet of any shape, with supports and loads on its sides.

    Parameters
    ----------
    shape : {"strip", "strip-with-hole", "notched-strip", "dog-bone", "ring-sector"}
        The shape; `Specimen.from_mesh` takes any.
    thickness : quantity
        Thickness at rest [mm].
    material : Material, str or path
        The material, or its card.
    supports : mapping
        How groups are held, by name: ``"clamp"``, ``"roller"``, ``"symmetry"``, or keys such as ``{"x": 45, "y": 0}`` and
        ``{"kind": "grip", "x_force": 3, "y": 0}``. Plain numbers are mm, N and rad. Several of one group stand in a list.
    loads : mapping, optional
        How groups are loaded: ``{"kind": "force", "x": 3}`` [N], ``{"kind": "traction", "y": 0.01}`` [MPa],
        ``{"kind": "pressure", "pressure": 0.01}`` [MPa].
    measured : str
        The group whose force is measured.
    cells : int
        Cells of the lattice across.
    lattice : {"quadrilaterals", "triangles"}
        Cells of the lattice.
    settings : mapping, optional
        Other keys of a study by section, such as ``{"finite_element": {"element": "T2"}}``.
    **measures : quantity
        Measures of the shape [mm]: ``length``, ``width``, ``hole_diameter``, ``notch_depth``, ``notch_length``,
        ``narrow_length``, ``narrow_width``, ``shoulder_length``, ``inner_radius``, ``outer_radius``; ``angle`` [rad].

    Examples
    --------
    >>> strip = gb.Specimen(
    ...     "strip-with-hole", length=90, width=30, hole_diameter=12, thickness=2, material="pva-10",
    ...     supports={"left": "clamp", "right": {"x": 45, "y": 0}}, measured="right")
    >>> strip.solve("finite-element").force
    """

    FACTORS = (1.0,)
    """Load factors where none are given."""

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
            raise fault(unknown[0], "is no measure of a shape", f"measures are {', '.join(MEASURES)}")
        own = {
            name: text(value, "rad" if name == "angle" else "mm", name) for name, value in measures.items()
        }
        specimen = {"shape": shape, **own, "cells": int(cells), "lattice": lattice}
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
        points : array_like, meshio.Mesh or pyvista.UnstructuredGrid
            Nodes, n × 2 or n × 3 with one z; or a whole mesh, whose named sets of nodes and lines are groups.
        cells : mapping, optional
            Nodes of the cells, m × k, counted from 0, by kind: ``triangle``, ``triangle6``, ``quad``, ``quad8``, ``quad9``.
        groups : mapping, optional
            Groups by name: numbers of nodes (n), or both ends of each line (n × 2). ``left``, ``right``, ``bottom``, ``top`` and
            ``boundary`` are there by themselves.
        unit : str
            Unit of the points.
        merge_nodes : quantity, optional
            Nodes not farther from each other become one [mm].
        allowed : sequence of {"seams", "parts", "hinges", "polygons"}
            What looks like a fault of the mesh but is meant.
        thickness, material, supports, measured, loads, settings
            As of `Specimen`.

        Notes
        -----
        Nodes of no cell are left out: fields have the order of `Solution.points`.
        """
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
        places = np.asarray(points, dtype=np.float64)
        if places.ndim == 2 and places.shape[1] == 2:
            places = np.column_stack([places, np.zeros(len(places))])
        mesh = _core.GivenMesh(
            floats(places, "points", (None, 3)),
            [(NUMBERS[name], _integers(block, "cells", 2)) for name, block in kinds.items()],
            {name: _integers(group, "groups", 1) for name, group in nodes.items()},
            {name: _integers(group, "groups", 2) for name, group in lines.items()},
        )
        specimen: dict[str, Any] = {"shape": "mesh", "file": "the mesh", "file_unit": unit}
        if merge_nodes is not None:
            specimen["merge_nodes"] = text(merge_nodes, "mm", "merge_nodes")
        if allowed:
            specimen["allowed"] = list(allowed)
        made = cls.__new__(cls)
        made._set(specimen, mesh, thickness, material, supports, measured, loads, settings)
        return made

    def _set(
        self,
        specimen: dict[str, Any],
        mesh: _core.GivenMesh | None,
        thickness: Quantity,
        material: Material | PathLike,
        supports: Mapping[str, Any],
        measured: str,
        loads: Mapping[str, Any] | None,
        settings: Settings | None,
    ) -> None:
        self.material = _material(material)
        self._mesh = mesh
        self._sections = _merged(
            {
                "material": {"card": reference(self.material)},
                "specimen": {**specimen, "thickness": text(thickness, "mm", "thickness")},
            },
            settings,
        )
        self._conditions = {"support": _entries(supports, "supports"), "load": _entries(loads or {}, "loads")}
        self._measured = measured

    def study(self, factors: Factors | None = None) -> str:
        """The text of the study, which the command runs too; a mesh in memory must first be saved under a name.

        Parameters
        ----------
        factors : array_like, optional
            As in `solve`.
        """
        return super().study(factors)

    def _text(self, factors: Factors | None, sections: dict[str, Any]) -> str:
        path = {"factors": _factors(factors, self.FACTORS), "measured_group": self._measured}
        conditions = {name: own for name, own in self._conditions.items() if own}
        return toml({"kind": "specimen", **sections, "path": path, **conditions})

    def _one(self, study: str, model: str, progress: Any, allow_large: bool) -> _core.Solution:
        return _core.solve_specimen(study, card(self.material), model, self._mesh, progress, allow_large)

    def _all(self, study: str, progress: Any, allow_large: bool) -> _core.Results:
        return _core.run_specimen(study, card(self.material), self._mesh, progress, allow_large)

    def __repr__(self) -> str:
        own = self._sections["specimen"]
        return f"<gelbench.Specimen {own['shape']}, {own['thickness']} thick, {self.material.name}>"


def _integers(values: Any, argument: str, dimensions: int) -> Any:
    array = np.asarray(values)
    if array.ndim != dimensions or not (np.issubdtype(array.dtype, np.integer) or array.size == 0):
        raise fault(argument, f"holds an array of {array.dtype} with the shape {array.shape}", "give numbers of nodes")
    return np.ascontiguousarray(array, dtype=np.int64)


def _entries(groups: Mapping[str, Any], argument: str) -> list[dict[str, Any]]:
    entries: list[dict[str, Any]] = []
    for group, given in groups.items():
        for one in given if isinstance(given, (list, tuple)) else [given]:
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


def run(path: PathLike, *, progress: Progress | None = None, allow_large: bool = False) -> Results:
    """Computes a study file of any kind, as ``gelbench run`` does; nothing is written.

    Parameters
    ----------
    path : str or path
        The study.
    progress : callable or tqdm bar, optional
        Is told each step in a line of text, from another thread.
    allow_large : bool
        Whether to let pass what needs more than a common machine has.

    Returns
    -------
    Results
        Everything that the command gives; `Results.write` writes its files.

    Raises
    ------
    gelbench.InputError
        With every fault of the study.
    gelbench.SolveError
        Where no model has any solution.
    """
    return Results(_core.run(os.fspath(path), callback(progress), allow_large))


def check(path: PathLike, *, allow_large: bool = False) -> tuple[str, list[str]]:
    """Reads a study file of any kind without computing it, as ``gelbench check`` does.

    Returns
    -------
    about : str
        What it will compute.
    warnings : list of str
        What deserves attention.

    Raises
    ------
    gelbench.InputError
        With every fault of the study.
    """
    return _core.check(os.fspath(path), allow_large)
