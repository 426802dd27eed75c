"""Measured displacement fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from numpy.typing import ArrayLike

from . import _core
from ._errors import fault
from ._given import GivenFiles, path_of, paths_of
from ._images import Images, image_options, images_of
from ._material import Material, card
from ._material import material as _material
from ._progress import Progress, callback
from ._quantities import PathLike, Quantity, positive, text, toml
from ._results import Field, Results
from ._tests import Data, Estimate

__all__ = ["Correction", "correct"]

COLUMNS = ("x [mm]", "y [mm]", "ux [mm]", "uy [mm]")


class Correction(Results):
    """The field nearest to measured displacements that satisfies the physics, frame by frame, with intervals."""

    def __init__(self, core: _core.Results, verdict: str) -> None:
        super().__init__(core)
        self._verdict = verdict

    def _more(self) -> dict[str, Any]:
        return {"verdict": self._verdict}

    @property
    def verdict(self) -> str:
        """``explained``, ``explained with correlated noise``, ``the data cannot judge``, or ``not explained by this law, thickness and conditions``."""
        return self._verdict

    @property
    def explained(self) -> bool:
        """Whether the intervals are valid."""
        return self._verdict.startswith("explained")

    @property
    def field(self) -> Field:
        """The corrected field of the last frame, with standard errors."""
        return self.fields["corrected"][-1]

    @property
    def markers(self) -> Field:
        """The markers of the last frame with their residuals."""
        return self.fields["markers"][-1]

    @property
    def noise(self) -> float:
        """Standard deviation of a component of a displacement in the last frame [mm]."""
        return float(self._last["noise_mm"])

    @property
    def forces(self) -> dict[str, tuple[Estimate, Estimate]]:
        """Forces on the edges that are not free, x and y [N], of the last frame."""
        found: dict[str, tuple[Estimate, Estimate]] = {}
        for one in self._last["forces"]:
            axes = (_estimate(one[f"{axis}_N"], "N") for axis in "xy")
            found[str(one["edge"])] = (next(axes), next(axes))
        return found

    @property
    def parameters(self) -> dict[str, Estimate]:
        """Parameters of the law estimated with the field of the last frame, by key; empty without ``fit=``."""
        return {str(one["key"]): _estimate(one["found"], str(one["unit"])) for one in self._last["parameters"]}

    @property
    def _last(self) -> dict[str, Any]:
        found: dict[str, Any] = self.json["steps"][-1]["corrected"]
        return found

    def _repr_html_(self) -> str:
        return f"<p><b>{self.verdict}</b></p>{super()._repr_html_()}"


def _estimate(one: Mapping[str, Any], unit: str) -> Estimate:
    interval = one.get("interval")
    pair = None if interval is None else (float(interval[0]), float(interval[1]))
    return Estimate(float(one["value"]), unit, one.get("standard_error"), pair)


def correct(
    markers: Data | None = None,
    material: Material | PathLike | None = None,
    thickness: Quantity | None = None,
    *,
    images: Images | None = None,
    free: Sequence[str] = (),
    rigid: Sequence[str] = (),
    known: Mapping[str, Mapping[str, Quantity]] | None = None,
    force: Mapping[str, Mapping[str, Quantity]] | None = None,
    noise: Quantity | None = None,
    edge_gap: Quantity | None = None,
    scale_error: Quantity | None = None,
    frame_interval: Quantity | None = None,
    clock_offset: Quantity | None = None,
    robust: str | None = None,
    physics: str | None = None,
    fit: Sequence[str] = (),
    sheet: str | None = None,
    regions: Mapping[str, Material | PathLike] | None = None,
    conditions: PathLike | None = None,
    unit: Quantity | None = None,
    array: str | None = None,
    grid: Quantity | None = None,
    columns: Mapping[str, str] | str | None = None,
    ignore_columns: str | Sequence[str] = (),
    encoding: str | None = None,
    y_axis: str | None = None,
    places: str | None = None,
    rest: PathLike | None = None,
    mesh: Any = None,
    mesh_unit: str = "mm",
    merge_nodes: Quantity | None = None,
    allow: Sequence[str] = (),
    outline: PathLike | ArrayLike | None = None,
    forces: Data | None = None,
    cell_size: Quantity | None = None,
    refine: bool = False,
    cells: str = "triangle6",
    holes: bool = True,
    spacing: int = 8,
    subset: int | None = None,
    subset_shape: str = "affine",
    mask: PathLike | ArrayLike | None = None,
    progress: Progress | None = None,
    allow_large: bool = False,
) -> Correction:
    """Makes a measured displacement field satisfy the physics: stresses, forces and their uncertainty follow.

    Parameters
    ----------
    markers : path, list of paths, DataFrame, mapping or array_like
        The field: files of image correlation programs, one for each frame; a table with ``x [mm]``, ``y [mm]``, ``ux [mm]``,
        ``uy [mm]``, and, if known, ``standard_deviation [mm]`` and ``frame``; or an array n × 4 of these in mm. Rows with
        NaN or masked entries are lost markers.
    images : path, list of paths or array_like
        Camera images instead, as of `gelbench.track`; `unit` is the length of a pixel.
    material : Material, str or path
        The material, or its card.
    thickness : quantity
        Thickness at rest [mm].
    free, rigid : sequence of str
        Edges without traction, and edges that moved as rigid bodies by unknown amounts: ``left``, ``right``, ``bottom``, ``top``, or
        groups of the mesh.
    known : mapping, optional
        Edges of known displacement: ``{"left": {"ux": 0, "uy": 0}}`` [mm].
    force : mapping, optional
        Measured forces of grips on the specimen [N]: ``{"right": {"x": 1.2, "x_deviation": 0.02}}``; without a deviation 1 %.
        Or columns of `forces`: ``{"right": {"x_column": "Load"}}``.
    noise : quantity, optional
        Standard deviation of the displacement components [mm]; estimated if omitted.
    edge_gap : quantity, optional
        How far inside the specimen's edge the outermost markers lie [mm].
    scale_error : quantity, optional
        Standard deviation of the scale of the pictures, such as ``"0.1 %"`` or 0.001: a specimen 1 mm nearer to a
        camera 1 m away seems to grow by this much.
    frame_interval, clock_offset : quantity, optional
        Time from one frame to the next where frames have none, and the time of the machine's table `forces` when that of the frames
        is at zero [s].
    robust : {"no", "huber", "tukey"}, optional
        Weights of outlying markers.
    physics : {"exact", "weighted"}, optional
        How exactly equilibrium holds.
    fit : sequence of str
        Parameters of the law to estimate with the field, or ``["all"]``, see `Correction.parameters`; a force must be measured.
        One frame seldom determines more than one.
    sheet : {"plane-stress", "plane-strain"}, optional
        A thin sheet with free surfaces (if omitted), or a thick body between walls, whose material needs a resistance to a change of
        volume.
    regions : mapping, optional
        The materials of named groups of the mesh's cells: ``{"inclusion": "pva-10"}``; all other cells are of `material`.
    conditions : path, optional
        A file with the known conditions, instead of the arguments from `free` to `sheet`.
    unit, array, grid, columns, ignore_columns, encoding, y_axis, places, rest
        How files are read; see the options of ``gelbench correct``.
    mesh, mesh_unit, merge_nodes, allow, outline, cell_size, refine, cells, holes
        The specimen's mesh (a file, or a mesh of meshio, PyVista or gmsh) or outline (a file, an array n × 2, or a list of these of which
        the inner ones are holes [mm]), and how it is meshed; see the same options. `mesh_unit` is a unit of length.
    forces : path, DataFrame or mapping, optional
        A testing machine's table for the frames; `force` or `conditions` names its columns.
    spacing, subset, subset_shape, mask
        How images are followed, as of `gelbench.track`.
    progress : callable or tqdm bar, optional
        Is called for each frame.
    allow_large : bool
        Whether to allow computations beyond a common machine.

    Returns
    -------
    Correction
        Field, forces with intervals, noise, and the verdict.

    Raises
    ------
    gelbench.InputError
        With all faults and their remedies.
    gelbench.SolveError
        If no corrected field was found.
    """
    if material is None or thickness is None:
        missing = "material" if material is None else "thickness"
        raise fault(missing, "is missing", "give the specimen's material and its thickness at rest")
    if (markers is None) == (images is None):
        wrong = "is missing" if images is None else "is given beside images"
        raise fault("markers", wrong, "give the field as markers, or as images=")
    own = _material(material)
    said = {
        "noise": noise if noise is None else text(noise, "mm", "noise"),
        "edge_gap": edge_gap if edge_gap is None else text(edge_gap, "mm", "edge_gap"),
        "scale_error": scale_error if scale_error is None else text(scale_error, "", "scale_error"),
        "frame_interval": frame_interval if frame_interval is None else text(frame_interval, "s", "frame_interval"),
        "clock_offset": clock_offset if clock_offset is None else text(clock_offset, "s", "clock_offset"),
        "robust": robust,
        "physics": physics,
        "fit": _names(fit) or None,
        "sheet": sheet,
    }
    listed = _edges(free, rigid, known or {})
    measured = _forces(force or {})
    if conditions is None:
        wanted: dict[str, Any] = {key: value for key, value in said.items() if value is not None}
        lists = {key: value for key, value in (("edges", listed), ("force", measured)) if value}
        what = toml({**wanted, **lists})
    elif listed or measured or any(value is not None for value in said.values()):
        raise fault("conditions", "is given in addition to the file", "state all conditions in the file, or none")
    else:
        try:
            what = Path(conditions).read_text(encoding="utf-8")
        except OSError as cause:
            raise fault("conditions", f"{conditions} cannot be read: {cause}", "name a file") from None
    in_memory = GivenFiles()
    options: dict[str, Any] = {
        "unit": unit if unit is None else text(unit, "mm", "unit"),
        "array": array,
        "grid": positive(grid, "mm", "grid"),
        "ignore_columns": _names(ignore_columns),
        "columns": columns.split(",") if isinstance(columns, str) else [f"{role}={column}" for role, column in (columns or {}).items()],
        "encoding": encoding,
        "y_axis": y_axis,
        "places": places,
        "rest": path_of(rest),
        "mesh": in_memory.mesh(mesh),
        "mesh_unit": mesh_unit,
        "merge_nodes": positive(merge_nodes, "mm", "merge_nodes"),
        "allow": _names(allow),
        "outline": in_memory.outline(outline),
        "forces": in_memory.optional_table(forces, "forces"),
        "cell_size": positive(cell_size, "mm", "cell_size"),
        "refine": refine,
        "cells": cells,
        "holes": holes,
        "regions": [(name, card(_material(one))) for name, one in (regions or {}).items()],
        "allow_large": allow_large,
    }
    size = positive(thickness, "mm", "thickness") or 0.0
    files, frames = ([], []) if images is None else images_of(images)
    if images is None:
        files = paths_of(markers) or [_table_of(markers, in_memory)]
    options["images"] = image_options(frames, spacing, subset, subset_shape, mask)
    options["in_memory"] = in_memory.files
    name = Path(conditions or (files[0] if files else "images")).stem
    return Correction(*_core.correct(name, files, card(own), size, what, options, callback(progress)))


def _names(given: str | Sequence[str]) -> list[str]:
    """One name or several."""
    return [given] if isinstance(given, str) else list(given)


def _table_of(markers: Any, in_memory: GivenFiles) -> str:
    if not hasattr(markers, "keys") and np.ndim(markers) != 2:
        raise fault("markers", f"has {np.ndim(markers)} dimensions", "give files, a table, or an array n × 4; images as images=")
    return in_memory.table(markers, "markers", COLUMNS)


def _edges(
    free: Sequence[str], rigid: Sequence[str], known: Mapping[str, Mapping[str, Quantity]]
) -> list[dict[str, Any]]:
    if isinstance(free, str) or isinstance(rigid, str):
        raise fault("free" if isinstance(free, str) else "rigid", "is a text", 'give a list of names, such as ["top", "bottom"]')
    edges: list[dict[str, Any]] = [
        {"names": list(names), "condition": condition} for names, condition in ((free, "free"), (rigid, "rigid")) if names
    ]
    for name, values in known.items():
        if not isinstance(values, Mapping):
            hint = 'give the known components, such as {"ux": 0, "uy": 0}; fixed edges are given this way too'
            raise fault(f"known.{name}", f"is {values!r}", hint)
        told = {axis: text(value, "mm", f"known.{name}.{axis}") for axis, value in values.items()}
        edges.append({"names": [name], "condition": "known", **told})
    return edges


def _forces(force: Mapping[str, Mapping[str, Quantity]]) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    keys = [axis + key for axis in "xy" for key in ("", "_column", "_deviation")]
    for edge, values in force.items():
        if not isinstance(values, Mapping):
            raise fault(f"force.{edge}", f"is {values!r}", 'give its components, such as {"x": 2.88, "x_deviation": 0.05}')
        for key in values:
            if key not in keys:
                raise fault(f"force.{edge}.{key}", "is not a key of a force", f"keys are {', '.join(keys)}")
            if key.endswith("_deviation") and not values.keys() & {key[0], f"{key[0]}_column"}:
                raise fault(f"force.{edge}.{key}", "belongs to a force that is not given", f"give {key[0]} too")
        for axis in ("x", "y"):
            row = {"edge": edge, "axis": axis}
            if axis in values:
                row["force"] = text(values[axis], "N", f"force.{edge}.{axis}")
            if f"{axis}_column" in values:
                row["column"] = str(values[f"{axis}_column"])
            if f"{axis}_deviation" in values:
                row["standard_deviation"] = text(values[f"{axis}_deviation"], "N", f"force.{edge}.{axis}_deviation")
            if "force" in row or "column" in row:
                rows.append(row)
    return rows
