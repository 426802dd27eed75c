"""Many runs of a study: its keys varied over grids, lists, distributions and given points."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import fault
from ._plate import Plate
from ._progress import Progress, callback
from ._quantities import PathLike, SupportsUnits, as_stated, converted, pint_unit, refuse_masked, scalar, whole
from ._specimen import Specimen
from ._study import Factors
from ._sweep_table import Column, SweepTable
from ._tests import Fit

if TYPE_CHECKING:
    import pandas

__all__ = ["SweepPlan", "salib_problem", "sweep"]

Values: TypeAlias = "str | Sequence[Any] | NDArray[Any]"
"""A text as after ``--vary KEY=``, or the values themselves."""

Points: TypeAlias = "Mapping[str, ArrayLike] | pandas.DataFrame"
"""Columns by keys with their units, such as ``plate.width [mm]``."""

Drawing: TypeAlias = Literal["sobol", "random"]


UnitOf: TypeAlias = "Callable[[str], str]"
"""The unit that plain numbers of a key are in; empty where they need none, or where it is not known."""


def _no_unit(_: str) -> str:
    return ""


def _word(value: Any, key: str, unit: str = "") -> str:
    """One value as a text, as in a study; a plain number is in the unit."""
    text = scalar(value)
    if text is not None:
        return f"{text} {unit}".rstrip()
    if isinstance(value, SupportsUnits):
        return as_stated(value)
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    raise fault(f"parameters.{key}", f"{value!r} is not a value of a key", "give numbers, texts or quantities")


def _is_single(values: Any) -> bool:
    return not isinstance(values, Iterable) or (isinstance(values, SupportsUnits) and np.ndim(values.magnitude) == 0)


def _refuse_masked(values: Any, key: str) -> None:
    refuse_masked(values.magnitude if isinstance(values, SupportsUnits) else values, key)


def _varied(parameters: Mapping[str, Values] | None, unit_of: UnitOf = _no_unit) -> list[tuple[str, str | list[str]]]:
    def of(key: str, values: Any) -> str | list[str]:
        if isinstance(values, str):
            return values
        if _is_single(values):
            return [_word(values, key, unit_of(key))]
        _refuse_masked(values, f"parameters.{key}")
        return [_word(value, key, unit_of(key)) for value in values]

    return [(key, of(key, values)) for key, values in (parameters or {}).items()]


def _columns(points: Points | None, unit_of: UnitOf) -> list[tuple[str, list[str]]] | None:
    if points is None:
        return None
    found: list[tuple[str, list[str]]] = []
    for head, column in points.items():
        name, own = str(head), column
        _refuse_masked(own, f"points.{name}")
        if isinstance(own, SupportsUnits):
            if not name.endswith("]"):
                unit = pint_unit(own)
                name = f"{name} [{unit}]" if unit else name
            own = converted(own, name.rpartition("[")[2].rstrip("]") if name.endswith("]") else "", f"points.{name}")
        values: Iterable[Any] = np.asarray(own).ravel().tolist()
        if unit_of(name) and all(isinstance(value, (int, float)) for value in values):
            name = f"{name} [{unit_of(name)}]"
        found.append((name, [_word(value, name) for value in values]))
    return found


def salib_problem(parameters: Mapping[str, Values]) -> dict[str, Any]:
    """Distributions as SALib takes them.

    Parameters
    ----------
    parameters : mapping
        Distributions by keys, ``"45..55 mm"`` or ``"0.05+-0.002 MPa"``.

    Returns
    -------
    dict
        ``num_vars``, ``names`` (keys with their units), ``bounds``, and ``dists``: ``unif`` between both bounds, ``norm`` with mean
        and standard deviation.

    Examples
    --------
    >>> from SALib.sample import sobol as sample
    >>> from SALib.analyze import sobol as analyse
    >>> problem = gb.salib_problem({"material.c10": "0.05+-0.002 MPa", "plate.width": "45..55 mm"})
    >>> points = dict(zip(problem["names"], sample.sample(problem, 64).T))
    >>> table = gb.sweep("plate.toml", points=points)
    >>> analyse.analyze(problem, table["corrected.force_N@0.5"])["ST"]
    """
    found = _core.distributions(_varied(parameters))
    return {
        "num_vars": len(found),
        "names": [f"{key} [{unit}]" if unit else key for key, _, _, unit in found],
        "bounds": [list(numbers) for _, _, numbers, _ in found],
        "dists": ["norm" if is_normal else "unif" for _, is_normal, _, _ in found],
    }


def _program() -> str:
    """The file of the program: a sweep is continued only by the same one."""
    return str(_core.__file__)


class SweepPlan:
    """The runs of a sweep, which are computed here, or in parts by other processes and machines.

    Plans can be pickled; the files that a study names, such as cards, must be at the same paths wherever it is computed.

    Parameters
    ----------
    study, parameters, points, fit, samples, method, seed, factors, allow_large
        As of `sweep`.

    Examples
    --------
    With a cluster of ``dask.distributed``, which recomputes the parts of lost workers:

    >>> plan = gb.SweepPlan("plate.toml", {"material.c10": "0.05+-0.002 MPa"}, samples=256)
    >>> parts = client.map(plan.part, range(1, 65), parts=64, pure=False)
    >>> table = plan.join(client.gather(parts))
    """

    def __init__(
        self,
        study: PathLike | Plate | Specimen,
        parameters: Mapping[str, Values] | None = None,
        *,
        points: Points | None = None,
        fit: Fit | PathLike | None = None,
        samples: int | None = None,
        method: Drawing = "sobol",
        seed: int = 1,
        factors: Factors | None = None,
        allow_large: bool = False,
    ) -> None:
        files: dict[str, bytes] = {}
        read: list[str] = []
        unit_of: UnitOf = _no_unit
        if isinstance(study, (Plate, Specimen)):
            path, text, files = study._in_memory(factors)
            unit_of = study._unit_of
        else:
            if factors is not None:
                raise fault("factors", "a study file states its own", "vary its keys, such as load.stretches.0")
            path = os.path.abspath(os.fspath(study))
            text = _core.text_of_file(path)
            read.append(path)
        fitted: tuple[str, str] | None = None
        if isinstance(fit, Fit):
            fitted = ("the fit", json.dumps(fit.json))
        elif fit is not None:
            name = os.path.abspath(os.fspath(fit))
            fitted = (name, _core.text_of_file(name))
            read.append(name)
        varied, columns = _varied(parameters, unit_of), _columns(points, unit_of)
        samples = None if samples is None else whole(samples, "samples", 1)
        seed = whole(seed, "seed")
        self._inputs = read
        self._told = (path, text, files, varied, columns, fitted, samples, method, seed, allow_large)
        self._core = _core.Sweep(*self._told)

    def __getstate__(self) -> tuple[Any, ...]:
        return self._inputs, self._told

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self._inputs, self._told = state
        self._core = _core.Sweep(*self._told)

    def __len__(self) -> int:
        return len(self._core)

    @property
    def study(self) -> str:
        """The text of the study."""
        return self._told[1]

    @property
    def settings(self) -> dict[str, Column]:
        """Values set in each run, by keys with their units."""
        return dict(self._core.settings())

    def run(
        self,
        *,
        output: PathLike | None = None,
        shard: tuple[int, int] | None = None,
        join: int | None = None,
        progress: Progress | None = None,
    ) -> SweepTable:
        """Computes the runs, as `sweep` does."""
        if join is not None and output is None:
            raise fault("join", "needs the folder of the parts", "give output=")
        folder = None if output is None else os.path.abspath(os.fspath(output))
        told = callback(progress)
        found = self._core.run(shard, join, folder, self._inputs, _program(), told)
        return SweepTable(found)

    def part(self, part: int, parts: int) -> SweepTable:
        """Computes one of several parts, and writes nothing: a function for schedulers such as Dask.

        Parameters
        ----------
        part : int
            The part, from 1.
        parts : int
            Number of parts; with ``len(plan)`` each is one run.
        """
        return self.run(shard=(part, parts))

    def join(self, tables: Iterable[SweepTable]) -> SweepTable:
        """The tables of all parts joined, identical to the table of one `run`.

        Raises
        ------
        gelbench.InputError
            If they are not the parts of this plan, or some are missing.
        """
        return SweepTable(self._core.join([table._core for table in tables]))

    def __repr__(self) -> str:
        return f"<gelbench.SweepPlan: {len(self)} runs over {', '.join(self.settings)}>"


def sweep(
    study: PathLike | Plate | Specimen,
    parameters: Mapping[str, Values] | None = None,
    *,
    points: Points | None = None,
    fit: Fit | PathLike | None = None,
    samples: int | None = None,
    method: Drawing = "sobol",
    seed: int = 1,
    output: PathLike | None = None,
    shard: tuple[int, int] | None = None,
    join: int | None = None,
    progress: Progress | None = None,
    factors: Factors | None = None,
    allow_large: bool = False,
) -> SweepTable:
    """Computes a study many times with some of its keys varied, as ``gelbench sweep`` does.

    Parameters
    ----------
    study : str, path, Plate or Specimen
        A study file, or a problem.
    parameters : mapping
        Values by keys, whose parts have dots between them: ``plate.thickness``, ``material.c10``, ``load.stretches.0``. A text is
        what stands behind ``--vary KEY=``: ``"0.04..0.06 MPa:20"`` a grid, ``"1 mm,2 mm"`` values, ``"45..55 mm"`` a uniform and
        ``"0.05+-0.002 MPa"`` a normal distribution. A list or an array has the values themselves, with units where the study has
        them: ``["1 mm", "2 mm"]``, or quantities of pint; plain numbers for a plate or a specimen are in mm, rad and the units of its
        material's parameters. Every combination is run.
    points : mapping or DataFrame, optional
        Points of one's own, such as those of SALib, in place of drawn ones: columns by keys with their units,
        ``{"plate.width [mm]": widths}``.
    fit : Fit, str or path, optional
        Draws the parameters of the study's card with their correlation; a path is that of the JSON file of
        ``gelbench materials fit``.
    samples : int, optional
        How many points of the distributions are drawn.
    method : {"sobol", "random"}
        How they are drawn.
    seed : int
        What tells one drawing from another.
    output : str or path, optional
        A folder for the command's files, where each run is kept as soon as it ends: the same call goes on after a kill or
        Ctrl-C. Without it nothing is written.
    shard : (int, int), optional
        Computes one part, from 1, of so many; ``output`` has a folder for each.
    join : int, optional
        Puts together so many parts that are in ``output``.
    progress : callable or tqdm bar, optional
        Is told each run that has ended, from another thread.
    factors : array_like, optional
        Load factors of a plate or specimen, as in `Plate.solve`; a study file states its own.
    allow_large : bool
        Whether to allow computations beyond a common machine.

    Returns
    -------
    SweepTable
        A row for each run, in the order of their numbers.

    Raises
    ------
    gelbench.InputError
        With every fault of the study and of what is varied. A run without a solution is none: it stands in `SweepTable.faults`.
    gelbench.WriteError
        If files cannot be written.

    Notes
    -----
    Runs are computed in parallel, other Python threads continue meanwhile, and Ctrl-C stops the computation.

    Examples
    --------
    >>> table = gb.sweep(gb.Plate(), {"plate.thickness": "1..3 mm:5"}, factors=[0.5], output="output/thickness")
    >>> table["corrected.force_N@0.5"]
    """
    plan = SweepPlan(
        study,
        parameters,
        points=points,
        fit=fit,
        samples=samples,
        method=method,
        seed=seed,
        factors=factors,
        allow_large=allow_large,
    )
    return plan.run(output=output, shard=shard, join=join, progress=progress)
