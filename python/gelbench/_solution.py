"""Equilibria of one model."""

from __future__ import annotations

import html
import os
from collections.abc import Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import WriteError, fault
from ._kept import save_values, values_of
from ._fields import Cells, cells_of, to_meshio, to_pyvista
from ._plots import deformed, forces, inline
from ._quantities import Floats, PathLike, array_of, finite, floats

if TYPE_CHECKING:
    import meshio
    import pyvista
    from matplotlib.axes import Axes

__all__ = ["AtPoints", "GroupForce", "Solution", "State"]


class GroupForce(NamedTuple):
    """Force, moment and displacement of a group of nodes that is supported, loaded or measured."""

    force: Floats
    """Force of the supports on the sheet, x and y [N]."""
    moment: float
    """Moment of that force about the group's mean deformed position [N·mm], counter-clockwise."""
    displacement: Floats
    """Mean displacement, x and y [mm]."""


class AtPoints(NamedTuple):
    """A state at points of the sheet."""

    displacement: Floats
    """ux, uy [mm], n × 2."""
    stress: Floats
    """Cauchy stress σ₁₁, σ₂₂, σ₁₂ [MPa], n × 3."""
    stretches: Floats
    """Principal stretches: larger in-plane, smaller in-plane, thickness, n × 3."""


class State:
    """An equilibrium at one load factor.

    Arrays at nodes have the order of `Solution.points`.
    """

    __slots__ = ("_arrays", "_errors", "_solution", "_step", "factor")

    factor: float
    """Load factor, or the stretch of a plate."""

    def __init__(self, solution: Solution, step: int, factor: float, errors: dict[str, float]) -> None:
        self._solution = solution
        self._step = step
        self._errors = errors
        self._arrays: tuple[dict[str, Floats], dict[str, Floats]] | None = None
        self.factor = factor

    @property
    def displacement(self) -> Floats:
        """ux, uy of every node [mm], n × 2; read-only, in the library's own memory: copy it to change it."""
        return self._solution._core.displacement(self._step)

    @property
    def residual(self) -> Floats:
        """Internal forces of every node [N], n × 2; read-only."""
        return self._solution._core.residual(self._step)

    @property
    def force(self) -> float:
        """Force on the moving grip of a plate, or of supports and loads on the measured group of a specimen [N]."""
        return self._solution._core.forces()[self._step]

    @property
    def groups(self) -> dict[str, GroupForce]:
        """Force, moment and displacement of each group that is supported, loaded or measured."""
        found = self._solution._core.at_groups(self._step)
        return {
            name: GroupForce(np.array(force), moment, np.array(displacement))
            for name, (force, moment, displacement) in found.items()
        }

    @property
    def energy(self) -> float:
        """Strain energy [mJ]."""
        return self._solution._core.energy(self._step)

    @property
    def balance(self) -> float:
        """Residual of the balance of all forces and moments, relative to the largest of them."""
        return self._solution._core.balance(self._step)

    @property
    def residuals(self) -> Floats:
        """Relative residual after each iteration."""
        return np.array(self._solution._core.residuals(self._step))

    @property
    def multipliers(self) -> dict[str, Floats]:
        """Lagrange multipliers of a corrected plate by condition: ζ [mm²/N], η [mm] or [mm²/N]."""
        return self._solution._core.multipliers(self._step)

    @property
    def error(self) -> dict[str, float]:
        """Errors in percent after ``solve(..., reference=True)``.

        For springs and corrected fields the deviation from the finite elements, for finite elements their own error. The
        names are those of ``report.json``.
        """
        return dict(self._errors)

    @property
    def point_data(self) -> dict[str, Floats]:
        """Arrays at the nodes, read-only, as in VTK files: the unit is part of each name.

        Vectors have the components x, y. Symmetric tensors, such as Cauchy stress and Green–Lagrange strain, have 11, 22, 33, 12
        (n × 4); the nominal stress, which is not symmetric, has P₁₁, P₂₁, P₁₂, P₂₂, P₃₃ (n × 5).
        """
        return self._data()[0]

    @property
    def cell_data(self) -> dict[str, Floats]:
        """Arrays in the cells, read-only, as in VTK files: the unit is part of each name, and components are those of `point_data`."""
        return self._data()[1]

    @property
    def stress(self) -> Floats:
        """Cauchy stress σ₁₁, σ₂₂, σ₃₃, σ₁₂ at every node [MPa], n × 4; read-only."""
        return self.point_data["cauchy_stress_at_nodes_MPa"]

    def at(self, points: ArrayLike) -> AtPoints:
        """Displacement, stress and stretches at points of the sheet.

        Parameters
        ----------
        points : array_like
            Places at rest [mm], n × 2, or one place.

        Raises
        ------
        gelbench.InputError
            If a point is not on the sheet.
        """
        own = array_of(points, "points", "mm")
        places = finite(floats(np.atleast_2d(own), "points", (None, 2)), "points")
        found = self._solution._core.at(self._step, places)
        return AtPoints(*(one[0] if own.ndim == 1 else one for one in found))

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The state as a grid of PyVista; warp it by ``displacement_mm`` to see it deformed."""
        solution = self._solution
        return to_pyvista(solution.points, solution.cells, self.point_data, self.cell_data)

    def to_meshio(self) -> meshio.Mesh:
        """The state as a mesh of meshio, which writes it in many formats."""
        solution = self._solution
        return to_meshio(solution.points, solution.cells, self.point_data, self.cell_data)

    def plot(
        self, quantity: str = "von_mises_stress_at_nodes_MPa", ax: Axes | None = None, *, component: int = 0, **options: Any
    ) -> Axes:
        """Draws the deformed sheet.

        Parameters
        ----------
        quantity : str
            An array of `point_data`.
        component : int
            Of vectors and tensors the number of the component that is drawn.
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        **options
            For `matplotlib.axes.Axes.tripcolor`.

        Returns
        -------
        matplotlib.axes.Axes
        """
        return deformed(self, quantity, component, ax, options)

    def _data(self) -> tuple[dict[str, Floats], dict[str, Floats]]:
        if self._arrays is None:
            self._arrays = self._solution._core.arrays(self._step)
        return self._arrays

    @property
    def solution(self) -> Solution:
        """The solution that the state belongs to."""
        return self._solution

    def __repr__(self) -> str:
        return f"<gelbench.State at {self.factor:g}: {self.force:.6g} N>"

    def _repr_html_(self) -> str:
        head = f"{html.escape(self._solution.model)} at {self.factor:g}: {self.force:.6g} N"
        return f"{head}<br>{inline(lambda ax: self.plot(ax=ax))}"


def _of_last(name: str) -> Any:
    return property(attrgetter(f"last.{name}"), doc=f"`State.{name}` of the last state.")


class Solution(Sequence[State]):
    """The equilibria of one model, one `State` for each load factor.

    A solution has the attributes of a state, which refer to its last state. Without a state they raise an `IndexError`. Solutions
    can be pickled, copied and saved; `at` is possible only of those that the process has computed itself.
    """

    def __init__(self, core: _core.Solution, model: str, errors: dict[float, dict[str, float]]) -> None:
        self._core = core
        self._model = model
        states = enumerate(core.factors())
        self._states = [State(self, step, factor, errors.get(factor, {})) for step, factor in states]

    def save(self, path: PathLike) -> None:
        """Writes everything into one compressed file of NumPy, such as ``plate.npz``, which `gelbench.load` reads; the last state alone into a
        file for ParaView if it is named ``.vtu``.

        Raises
        ------
        gelbench.WriteError
            If the file cannot be written.
        gelbench.InputError
            If the file has another name.
        """
        kind = os.path.splitext(os.fspath(path))[1].lower()
        if kind not in ("", ".npz", ".vtu"):
            raise fault("path", f"{os.fspath(path)!r} is a file of another kind", "name it .npz, or .vtu for ParaView; to_meshio() writes others")
        if kind == ".vtu":
            try:
                self.to_meshio().write(path, file_format="vtu")
            except OSError as cause:
                raise WriteError(f"{path} cannot be written: {cause}") from cause
            return
        errors = [[state.factor, state._errors] for state in self]
        save_values(path, {"type": "Solution", "model": self._model, "errors": errors, "values": values_of(self._core)})

    @property
    def model(self) -> str:
        """Name of the model."""
        return self._model

    @property
    def points(self) -> Floats:
        """Nodes at rest [mm], n × 2; read-only."""
        return self._core.points

    @property
    def cells(self) -> Cells:
        """Cells by their meshio names: the number of each, and its nodes."""
        return cells_of(self._core.cells())

    @property
    def nodes(self) -> dict[str, NDArray[np.int64]]:
        """Nodes of the groups of the mesh."""
        return self._core.group_nodes()

    @property
    def thickness(self) -> float:
        """Thickness at rest [mm]."""
        return self._core.thickness

    @property
    def seconds(self) -> float:
        """Computing time of the library [s]."""
        return self._core.seconds

    @property
    def warnings(self) -> list[str]:
        """Warnings, such as stretches beyond the range of the card."""
        return self._core.warnings

    @property
    def factors(self) -> Floats:
        """Load factors that were reached; stretches of a plate."""
        return np.array(self._core.factors())

    @property
    def forces(self) -> Floats:
        """The `force` of every state [N]."""
        return np.array(self._core.forces())

    @property
    def last(self) -> State:
        """The state at the last load factor."""
        if not self._states:
            raise IndexError("the solution has no state: no load factor was reached")
        return self._states[-1]

    displacement: Floats = _of_last("displacement")
    residual: Floats = _of_last("residual")
    residuals: Floats = _of_last("residuals")
    groups: dict[str, GroupForce] = _of_last("groups")
    energy: float = _of_last("energy")
    balance: float = _of_last("balance")
    multipliers: dict[str, Floats] = _of_last("multipliers")
    point_data: dict[str, Floats] = _of_last("point_data")
    cell_data: dict[str, Floats] = _of_last("cell_data")
    force: float = _of_last("force")
    stress: Floats = _of_last("stress")
    error: dict[str, float] = _of_last("error")

    def at(self, points: ArrayLike) -> AtPoints:
        """`State.at` of the last state."""
        return self.last.at(points)

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """`State.to_pyvista` of the last state."""
        return self.last.to_pyvista()

    def to_meshio(self) -> meshio.Mesh:
        """`State.to_meshio` of the last state."""
        return self.last.to_meshio()

    def plot(
        self, quantity: str = "von_mises_stress_at_nodes_MPa", ax: Axes | None = None, **options: Any
    ) -> Axes:
        """`State.plot` of the last state."""
        return self.last.plot(quantity, ax, **options)

    def plot_forces(self, ax: Axes | None = None) -> Axes:
        """Draws the force over the load factor."""
        return forces(self, ax)

    def __len__(self) -> int:
        return len(self._states)

    @overload
    def __getitem__(self, index: int) -> State: ...
    @overload
    def __getitem__(self, index: slice) -> list[State]: ...
    def __getitem__(self, index: int | slice) -> State | list[State]:
        return self._states[index]

    def __repr__(self) -> str:
        told = f", {len(self.warnings)} warnings" if self.warnings else ""
        return f"<gelbench.Solution {self.model}: {len(self.points)} nodes, {len(self)} states{told}>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><td>{state.factor:g}</td><td>{state.force:.6g}</td></tr>" for state in self)
        head = f"<b>{html.escape(self.model)}</b>, {len(self.points)} nodes"
        table = f"<table><tr><th>load factor</th><th>force [N]</th></tr>{rows}</table>"
        told = "".join(f"<p>{html.escape(warning)}</p>" for warning in self.warnings)
        return head + table + told + (self.last._repr_html_() if self._states else "")
