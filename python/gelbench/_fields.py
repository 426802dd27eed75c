"""Meshes and fields for PyVista and meshio."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ._errors import fault
from ._quantities import Floats

if TYPE_CHECKING:
    import meshio
    import pyvista

__all__ = ["Cells", "cells_of", "to_meshio", "to_pyvista"]

Integers: TypeAlias = NDArray[np.int64]
Cells: TypeAlias = "dict[str, tuple[Integers, Integers]]"

NAMES = {
    1: "vertex",
    3: "line",
    5: "triangle",
    9: "quad",
    22: "triangle6",
    23: "quad8",
    28: "quad9",
}
"""Cell names of meshio by VTK cell type."""

NUMBERS = {name: number for number, name in NAMES.items()}

GMSH = {
    "Triangle 3": "triangle",
    "Quadrilateral 4": "quad",
    "Triangle 6": "triangle6",
    "Quadrilateral 8": "quad8",
    "Quadrilateral 9": "quad9",
}
"""Cell names of meshio by gmsh's."""


def cells_of(blocks: list[tuple[int, Integers, Integers]]) -> Cells:
    """Cells by their names."""
    return {NAMES[kind]: (numbers, points) for kind, numbers, points in blocks}


def _places(points: Floats) -> Floats:
    return np.column_stack([points, np.zeros(len(points))])


def _shaped(values: Floats) -> Floats:
    """Vectors with a third component, tensors unchanged."""
    if values.ndim == 2 and values.shape[1] == 2:
        return _places(values)
    return values


def to_pyvista(
    points: Floats, cells: Cells, point_data: Mapping[str, Floats], cell_data: Mapping[str, Floats]
) -> pyvista.UnstructuredGrid:
    """A grid of PyVista with the cells sorted by kind."""
    import pyvista

    grid: Any = pyvista.UnstructuredGrid({NUMBERS[name]: own for name, (_, own) in cells.items()}, _places(points))
    order = np.concatenate([numbers for numbers, _ in cells.values()])
    for name, values in point_data.items():
        grid.point_data[name] = _shaped(values)
    for name, values in cell_data.items():
        grid.cell_data[name] = _shaped(values[order])
    found: pyvista.UnstructuredGrid = grid
    return found


def to_meshio(
    points: Floats, cells: Cells, point_data: Mapping[str, Floats], cell_data: Mapping[str, Floats]
) -> meshio.Mesh:
    """A mesh of meshio."""
    import meshio

    blocks: Any = [(name, own) for name, (_, own) in cells.items()]
    return meshio.Mesh(
        _places(points),
        blocks,
        point_data={name: _shaped(values) for name, values in point_data.items()},
        cell_data={
            name: [_shaped(values[numbers]) for numbers, _ in cells.values()] for name, values in cell_data.items()
        },
    )


def read_mesh(
    mesh: Any,
) -> tuple[Floats, dict[str, Integers], dict[str, Integers], dict[str, Integers]]:
    """Points, cells, groups of nodes and groups of lines of a mesh of meshio, a grid of PyVista or the model of gmsh."""
    if hasattr(mesh, "cells_dict") and hasattr(mesh, "celltypes"):
        return np.asarray(mesh.points), _of_pyvista(mesh), {}, {}
    if hasattr(mesh, "cells") and hasattr(mesh, "point_sets"):
        return np.asarray(mesh.points), *_of_meshio(mesh)
    if hasattr(mesh, "model") and hasattr(mesh, "write"):
        return _of_gmsh(mesh.model)
    hint = "give a file, a meshio.Mesh, a pyvista.UnstructuredGrid, the module gmsh with its model, or points and cells"
    raise fault("points", f"{type(mesh).__name__} is not a mesh", hint)


def _of_gmsh(model: Any) -> tuple[Floats, dict[str, Integers], dict[str, Integers], dict[str, Integers]]:
    tags, places, _ = model.mesh.getNodes()
    numbers = np.zeros(int(max(tags, default=0)) + 1, dtype=np.int64)
    numbers[tags] = np.arange(len(tags))

    def blocks(dimension: int, tag: int) -> list[tuple[str, Integers]]:
        kinds, _, nodes = model.mesh.getElements(dimension, tag)
        known = [(model.mesh.getElementProperties(kind), own) for kind, own in zip(kinds, nodes, strict=True)]
        return [(GMSH.get(str(name), str(name)), numbers[own].reshape(-1, count)) for (name, _, _, count, *_), own in known]

    cells: dict[str, list[Integers]] = {}
    for name, block in blocks(2, -1):
        cells.setdefault(name, []).append(block)
    groups: dict[int, dict[str, list[Integers]]] = {0: {}, 1: {}}
    for dimension, tag in model.getPhysicalGroups():
        name = model.getPhysicalName(dimension, tag) or f"physical-{tag}"
        for entity in model.getEntitiesForPhysicalGroup(dimension, tag):
            for _, block in blocks(dimension, entity) if dimension < 2 else []:
                groups[dimension].setdefault(name, []).append(block[:, : dimension + 1])
    joined = {name: np.concatenate(parts) for name, parts in cells.items()}
    nodes = {name: np.concatenate(parts).ravel() for name, parts in groups[0].items()}
    return places.reshape(-1, 3), joined, nodes, {name: np.concatenate(parts) for name, parts in groups[1].items()}


def _of_pyvista(grid: Any) -> dict[str, Integers]:
    own: dict[int, Integers] = grid.cells_dict
    unknown = [kind for kind in own if int(kind) not in NAMES]
    if unknown:
        raise fault("points", f"the grid has cells of VTK type {unknown[0]}", "give triangles and quadrilaterals")
    return {NAMES[int(kind)]: np.asarray(points, dtype=np.int64) for kind, points in own.items()}


def _of_meshio(mesh: Any) -> tuple[dict[str, Integers], dict[str, Integers], dict[str, Integers]]:
    cells: dict[str, list[Integers]] = {}
    for block in mesh.cells:
        cells.setdefault(block.type, []).append(np.asarray(block.data, dtype=np.int64))
    lines: dict[str, list[Integers]] = {}
    for name, parts in mesh.cell_sets.items():
        for block, chosen in zip(mesh.cells, parts, strict=True):
            if block.type.startswith("line") and chosen is not None and len(chosen):
                lines.setdefault(name, []).append(np.asarray(block.data)[np.asarray(chosen, dtype=np.int64), :2])
    physical = mesh.cell_data.get("gmsh:physical")
    for name, (number, dimension) in mesh.field_data.items():
        for block, numbers in zip(mesh.cells, physical or [], strict=physical is not None):
            if dimension == 1 and block.type.startswith("line"):
                chosen = np.asarray(numbers) == number
                if chosen.any() and name not in mesh.cell_sets:
                    lines.setdefault(name, []).append(np.asarray(block.data)[chosen, :2])
    nodes = {name: np.asarray(own, dtype=np.int64) for name, own in mesh.point_sets.items()}
    joined = {name: np.concatenate(parts) for name, parts in cells.items()}
    return joined, nodes, {name: np.concatenate(parts).astype(np.int64) for name, parts in lines.items()}
