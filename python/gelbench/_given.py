"""Tables, lines and meshes in memory, as files that no disk has."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ._errors import fault
from ._quantities import PathLike, finite, floats
from ._tests import _table as table

__all__ = ["GivenFiles", "path_of", "paths_of"]


def paths_of(given: Any) -> list[str] | None:
    """One path or several; None for anything else."""
    if isinstance(given, (str, os.PathLike)):
        path: os.PathLike[str] | str = given
        return [os.fspath(path)]
    if isinstance(given, (list, tuple)) and given and all(isinstance(one, (str, os.PathLike)) for one in given):
        paths: Sequence[PathLike] = given
        return [os.fspath(path) for path in paths]
    return None


def path_of(path: PathLike | None) -> str | None:
    """A path as a text, if there is one."""
    return None if path is None else os.fspath(path)


def _bare(mesh: Any) -> Any:
    """A mesh of meshio with its groups and without its fields, which Gmsh's files may not take."""
    none = [np.zeros(len(block.data), dtype=np.int64) for block in mesh.cells]
    groups = {name: mesh.cell_data.get(name, none) for name in ("gmsh:physical", "gmsh:geometrical")}
    return type(mesh)(mesh.points, mesh.cells, cell_data=groups, field_data=mesh.field_data, point_sets=mesh.point_sets, cell_sets=mesh.cell_sets)


def _is_path(given: Any) -> bool:
    return given is None or isinstance(given, (str, os.PathLike))


class GivenFiles:
    """Objects that stand for files, by the names under which these are read."""

    def __init__(self) -> None:
        self.files: dict[str, bytes] = {}

    def table(self, data: Any, name: str, columns: Sequence[str]) -> str:
        """The name of a table."""
        return self._add(f"{name}.csv", table(data, name, columns)[1].encode())

    def optional_table(self, data: Any, name: str) -> str | None:
        """The path of a table on a disk, or the name of one in memory, whose columns have heads."""
        if _is_path(data):
            return path_of(data)
        if not hasattr(data, "keys"):
            raise fault(name, "has no columns with heads", "give a file, a DataFrame, or a mapping of columns")
        return self.table(data, name, ())

    def outline(self, outline: Any) -> str | None:
        """The path of an outline, or the name of one in memory."""
        if _is_path(outline):
            return path_of(outline)
        several = isinstance(outline, (list, tuple)) and all(np.ndim(line) == 2 for line in outline)
        lines: Any = outline if several else [outline]
        text = ["x [mm],y [mm],line"]
        for number, line in enumerate(lines, 1):
            points = finite(floats(line, "outline", (None, 2), "mm"), "outline")
            text += [f"{x:.17g},{y:.17g},{number}" for x, y in points]
        return self._add("outline.csv", ("\n".join(text) + "\n").encode())

    def mesh(self, mesh: Any) -> str | None:
        """The path of a mesh, or the name of one in memory: of meshio, PyVista or gmsh."""
        if _is_path(mesh):
            return path_of(mesh)
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            if hasattr(mesh, "cells") and hasattr(mesh, "point_sets"):
                file = Path(folder) / "mesh.msh"
                _bare(mesh).write(file, file_format="gmsh22", binary=False)
            elif hasattr(mesh, "cells_dict") and hasattr(mesh, "save"):
                file = Path(folder) / "mesh.vtu"
                mesh.save(file)
            elif hasattr(mesh, "model") and hasattr(mesh, "write"):
                file = Path(folder) / "mesh.msh"
                mesh.write(os.fspath(file))
            else:
                hint = "give a file, a meshio.Mesh, a pyvista.UnstructuredGrid, or the module gmsh with its model"
                raise fault("mesh", f"{type(mesh).__name__} is not a mesh", hint)
            return self._add(file.name, file.read_bytes())

    def _add(self, name: str, content: bytes) -> str:
        self.files[name] = content
        return name
