"""Results of studies, as the command reports them."""

from __future__ import annotations

import html
import io
import json
import os
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from ._fields import Cells, cells_of, to_meshio, to_pyvista
from ._kept import save_values, values_of
from ._plots import image
from ._quantities import Floats, PathLike

if TYPE_CHECKING:
    import meshio
    import pandas
    import pyvista

__all__ = ["Field", "Results"]


class Field:
    """A mesh with arrays, as in a VTK file: the unit is part of each array's name."""

    def __init__(self, core: _core.Results, series: int, number: int, time: float | None) -> None:
        self._core = core
        self._place = (series, number)
        self.time = time
        """Stretch, load factor, time [s] or frame; None where there is none."""

    @property
    def points(self) -> Floats:
        """Nodes at rest [mm], n × 2; read-only."""
        return self._core.field_points(*self._place)

    @property
    def cells(self) -> Cells:
        """Cells by their meshio names: the number of each, and its nodes."""
        return cells_of(self._core.field_cells(*self._place))

    @cached_property
    def _arrays(self) -> tuple[dict[str, Floats], dict[str, Floats]]:
        return self._core.field_arrays(*self._place)

    @property
    def point_data(self) -> dict[str, Floats]:
        """Arrays at the nodes, read-only; components as of `State.point_data`."""
        return self._arrays[0]

    @property
    def cell_data(self) -> dict[str, Floats]:
        """Arrays in the cells, read-only."""
        return self._arrays[1]

    @property
    def displacement(self) -> Floats:
        """ux, uy of every node [mm], n × 2; read-only."""
        return self.point_data["displacement_mm"]

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The field as a grid of PyVista."""
        return to_pyvista(self.points, self.cells, self.point_data, self.cell_data)

    def to_meshio(self) -> meshio.Mesh:
        """The field as a mesh of meshio."""
        return to_meshio(self.points, self.cells, self.point_data, self.cell_data)

    def __repr__(self) -> str:
        at = "" if self.time is None else f" at {self.time:g}"
        return f"<gelbench.Field{at}: {len(self.points)} nodes>"


class Results:
    """Results of a study: figures, requirements, warnings, fields, tables, pictures.

    Results can be pickled, copied and saved.
    """

    def __init__(self, core: _core.Results) -> None:
        self._core = core

    @property
    def title(self) -> str:
        """Title of the study."""
        return self._core.title

    @property
    def kind(self) -> str:
        """Kind of the study."""
        return self._core.kind

    @property
    def passed(self) -> bool:
        """Whether all requirements are met, without doubts, by models that did not end early."""
        return self._core.passed

    @property
    def summary(self) -> str:
        """What the command prints: forces and displacements of the groups, largest stress and stretch, then how far the models agree."""
        return self._core.summary

    @property
    def warnings(self) -> list[str]:
        """Warnings."""
        return self._core.warnings

    @property
    def doubts(self) -> list[str]:
        """Reasons to doubt the figures."""
        return self._core.doubts

    @property
    def seconds(self) -> float:
        """Computing time [s]."""
        return self._core.seconds

    @cached_property
    def json(self) -> dict[str, Any]:
        """All figures: what the command writes to ``report.json``."""
        found: dict[str, Any] = json.loads(self._core.json())
        return found

    @property
    def markdown(self) -> str:
        """The report as Markdown."""
        return self._core.markdown()

    @property
    def requirements(self) -> list[dict[str, Any]]:
        """The requirements and whether they are met."""
        found: list[dict[str, Any]] = self.json["requirements"]
        return found

    @cached_property
    def fields(self) -> dict[str, list[Field]]:
        """Fields by the names of their series, such as ``corrected``, in the order of their times."""
        found: dict[str, list[Field]] = {}
        for series, (name, times) in enumerate(self._core.fields()):
            found[name] = [Field(self._core, series, number, time) for number, time in enumerate(times)]
        return found

    @cached_property
    def tables(self) -> dict[str, pandas.DataFrame]:
        """Tables by file name."""
        import pandas

        return {name: pandas.read_csv(io.StringIO(text), comment="#") for name, text in self._core.tables()}

    @property
    def pictures(self) -> Mapping[str, bytes]:
        """Pictures as PNG by name; each is drawn on access."""
        return _Pictures(self._core)

    def save(self, path: PathLike) -> None:
        """Writes everything into one compressed file of NumPy, such as ``plate.npz``, which `gelbench.load` reads.

        Raises
        ------
        gelbench.WriteError
            If the file cannot be written.
        """
        save_values(path, {"type": type(self).__name__, **self._more(), "values": values_of(self._core)})

    def _more(self) -> dict[str, Any]:
        return {}

    def write(self, folder: PathLike | None = None) -> list[Path]:
        """Writes what the command writes: report, pictures, VTK files. As the command does, it replaces what gelbench has written into
        the folder before, and keeps other files of the same names as ``report.md.kept`` and the like.

        Parameters
        ----------
        folder : str or path, optional
            By default the folder named in the study, otherwise ``output/`` and the study's name.

        Returns
        -------
        list of pathlib.Path
            The files.

        Raises
        ------
        gelbench.WriteError
            If a file cannot be written, another process writes to the folder, or the study file itself would be replaced.
        """
        return [Path(path) for path in self._core.write(None if folder is None else os.fspath(folder))]

    def __repr__(self) -> str:
        verdict = "passed" if self.passed else "not passed"
        return f"{self.title}: {verdict}\n\n{self.summary}".rstrip()

    def _repr_html_(self) -> str:
        drawn = "".join(image(one) for one in list(self.pictures.values())[:2])
        told = "".join(f"<p>{html.escape(warning)}</p>" for warning in [*self.doubts, *self.warnings])
        return f"<h3>{html.escape(self.title)}</h3><pre>{html.escape(self.summary)}</pre>{told}{drawn}"


class _Pictures(Mapping[str, bytes]):
    def __init__(self, core: _core.Results) -> None:
        self._core = core
        self._names = [name for name, _ in core.pictures()]

    def __getitem__(self, name: str) -> bytes:
        if name not in self._names:
            raise KeyError(name)
        return self._core.picture(self._names.index(name))

    def __iter__(self) -> Any:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)
