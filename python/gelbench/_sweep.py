"""Many runs of a study: its keys varied over grids, lists, distributions and points of one's own."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import WriteError, fault
from ._plots import band_over_steps, inline
from ._progress import Progress, callback
from ._quantities import Floats, PathLike, SupportsUnits, scalar
from ._study import Factors, Plate, Specimen
from ._tests import Fit

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

__all__ = ["Band", "SweepPlan", "SweepTable", "salib_problem", "sweep"]

Values: TypeAlias = "str | Sequence[Any] | NDArray[Any]"
"""A text as behind ``--vary KEY=``, or the values themselves."""

Points: TypeAlias = "Mapping[str, ArrayLike] | pandas.DataFrame"
"""Columns by keys with their units, such as ``plate.width [mm]``."""

Column: TypeAlias = "Floats | list[str]"
"""Numbers, or texts such as names of cards."""

Drawing: TypeAlias = Literal["sobol", "random"]


class Band(NamedTuple):
    """A figure of all runs over the steps of the study."""

    at: Floats
    """Stretches, load factors, or times [s]."""
    low: Floats
    """5 % of the runs lie below."""
    median: Floats
    """Half of them."""
    high: Floats
    """95 % of them."""
    runs: NDArray[np.int64]
    """How many runs have the figure at each step."""


def _word(value: Any, key: str) -> str:
    """One value as a text, as a study has it."""
    text = scalar(value)
    if text is not None:
        return text
    if isinstance(value, SupportsUnits):
        return f"{float(value.magnitude)!r} {getattr(value, 'units', ''):~}".rstrip()
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    raise fault(f"parameters.{key}", f"{value!r} is no value of a key", "give numbers, texts or quantities")


def _varied(parameters: Mapping[str, Values] | None) -> list[tuple[str, str | list[str]]]:
    def of(key: str, values: Any) -> str | list[str]:
        if isinstance(values, str):
            return values
        if isinstance(values, Iterable):
            return [_word(value, key) for value in values]
        return [_word(values, key)]

    return [(key, of(key, values)) for key, values in (parameters or {}).items()]


def _columns(points: Points | None) -> list[tuple[str, list[str]]] | None:
    if points is None:
        return None
    found: list[tuple[str, list[str]]] = []
    for head, column in points.items():
        values: Iterable[Any] = np.asarray(column).ravel().tolist()
        found.append((str(head), [_word(value, str(head)) for value in values]))
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


class SweepTable:
    """What many runs of a study have found: one row for each.

    ``table["corrected.force_N@0.5"]`` is a column: figures are named by model, quantity with its unit, and the step, and are
    NaN where a run has none; what was varied is found by its key, with or without the unit. Tables can be pickled.
    """

    def __init__(self, core: _core.SweepTable) -> None:
        self._core = core

    def __len__(self) -> int:
        return len(self._core)

    @property
    def keys(self) -> list[str]:
        """What was varied."""
        return self._core.keys

    @cached_property
    def settings(self) -> dict[str, Column]:
        """What was set in each run, by keys with their units: numbers as arrays, others as lists of texts."""
        return dict(self._core.settings())

    @cached_property
    def figures(self) -> dict[str, Floats]:
        """All figures by their names, NaN where a run has none."""
        return dict(self._core.figures())

    @property
    def numbers(self) -> NDArray[np.int64]:
        """The runs' numbers, from 1."""
        return self._core.numbers()

    @property
    def passed(self) -> NDArray[np.bool_]:
        """Whether each run meets all that the study requires."""
        return self._core.passed()

    @property
    def faults(self) -> list[str]:
        """Why a run has no solution, or where a model ended early; empty texts where neither is the case."""
        return self._core.faults()

    @property
    def run_warnings(self) -> list[str]:
        """What deserves attention in each run, as ``sweep.csv`` has it: its warnings with `` | `` between them."""
        return self._core.run_warnings()

    @property
    def files(self) -> list[Path]:
        """The files that were written."""
        return [Path(path) for path in self._core.files]

    @property
    def warnings(self) -> list[str]:
        """What deserves attention: pictures that could not be drawn, and what is said of the runs, the same once."""
        return self._core.warnings

    def __getitem__(self, name: str) -> Column:
        if name in self.figures:
            return self.figures[name]
        for (head, values), key in zip(self.settings.items(), self.keys, strict=True):
            if name in (head, key):
                return values
        raise KeyError(name)

    @property
    def columns(self) -> dict[str, Any]:
        """The whole table, column by column, as ``sweep.csv`` has it."""
        first = {"run": self.numbers, **self.settings}
        return {**first, **self.figures, "passed": self.passed, "fault": self.faults, "warnings": self.run_warnings}

    @cached_property
    def json(self) -> dict[str, Any]:
        """Mean, standard deviation, quantiles and rank correlations of every figure, as ``sweep.json`` has them."""
        found: dict[str, Any] = json.loads(self._core.json())
        return found

    @cached_property
    def statistics(self) -> dict[str, dict[str, Any]]:
        """The same by the figures' names."""
        return {str(one["name"]): one for one in self.json["figures"]}

    def along(self, figure: str) -> tuple[Floats, Floats]:
        """A figure over the steps of the study.

        Parameters
        ----------
        figure : str
            Its name without the step, such as ``corrected.force_N``.

        Returns
        -------
        at : ndarray
            The n steps: stretches, load factors, or times [s].
        values : ndarray
            The figure, runs × n.
        """
        steps = self._steps(figure)
        return np.array(list(steps)), np.column_stack([self.figures[name] for name in steps.values()])

    def band(self, figure: str = "corrected.force_N") -> Band:
        """The band of a figure over the steps of the study.

        Parameters
        ----------
        figure : str
            Its name without the step.

        Returns
        -------
        Band
            Quantiles of 5, 50 and 95 % of the runs, linear between them.
        """
        steps = self._steps(figure)
        own = [self.statistics[name] for name in steps.values()]
        low, median, high = np.array([one["quantiles_5_50_95_percent"] for one in own], dtype=np.float64).T
        return Band(np.array(list(steps)), low, median, high, np.array([one["runs"] for one in own]))

    def _steps(self, figure: str) -> dict[float, str]:
        """The names of a figure by their steps, ascending."""
        split = [(name, *name.rpartition("@")[::2]) for name in self.figures]
        found = {float(at): name for name, own, at in split if own == figure}
        if not found:
            known = sorted({own for _, own, _ in split})
            raise fault("figure", f"there is no figure `{figure}`", f"figures are {', '.join(known)}")
        return dict(sorted(found.items()))

    def plot(self, *figures: str, ax: Axes | None = None) -> Axes:
        """Draws medians and bands, 5 … 95 % of the runs, over the steps of the study.

        Parameters
        ----------
        *figures : str
            Names without the step; by default ``corrected.force_N``.
        ax : matplotlib.axes.Axes, optional
            Where to draw.

        Returns
        -------
        matplotlib.axes.Axes
        """
        names = figures or ("corrected.force_N",)
        return band_over_steps({name: self.band(name) for name in names}, ax)

    @property
    def pictures(self) -> dict[str, bytes]:
        """The pictures of the report as PNG by their names."""
        return dict(self._core.pictures())

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a DataFrame."""
        import pandas

        return pandas.DataFrame(self.columns)

    def to_csv(self, path: PathLike) -> None:
        """Writes the table as the command does, which reads it back to the bit.

        Raises
        ------
        gelbench.WriteError
            Where it cannot be written; there is never half a file.
        """
        _written(path, lambda place: place.write_bytes(self._core.csv()))

    def to_parquet(self, path: PathLike) -> None:
        """Writes the table as Parquet, with pyarrow; figures that a run has not are null.

        Raises
        ------
        gelbench.WriteError
            Where it cannot be written; there is never half a file.
        """
        import pyarrow
        from pyarrow import parquet

        columns: dict[str, Any] = {
            name: pyarrow.array(column, mask=np.isnan(column)) if name in self.figures else pyarrow.array(column)
            for name, column in self.columns.items()
        }
        table = pyarrow.table(columns)
        _written(path, lambda place: parquet.write_table(table, place))

    def __reduce__(self) -> tuple[Any, ...]:
        return _of_text, (self._core.name, self.keys, self._core.csv())

    def __repr__(self) -> str:
        failed = sum(bool(one) for one in self.faults)
        told = f", {failed} without a solution somewhere" if failed else ""
        return f"<gelbench.SweepTable of {self._core.name}: {len(self)} runs over {', '.join(self.keys)}{told}>"

    def _repr_html_(self) -> str:
        wanted = ("force_N", "measured_N")
        last: dict[str, dict[str, Any]] = {}
        for name, one in self.statistics.items():
            if name.rpartition("@")[0].rpartition(".")[2] in wanted and name.count(".", 0, name.find("@")) == 1:
                last[name.partition(".")[0]] = one
        rows = "".join(
            f"<tr><td>{html.escape(one['name'])}</td><td>{one['runs']}</td>"
            + "".join(f"<td>{value:.5g}</td>" for value in [one["mean"], *one["quantiles_5_50_95_percent"]])
            + "</tr>"
            for one in last.values()
        )
        head = "<tr><th>figure</th><th>runs</th><th>mean</th><th>5 %</th><th>median</th><th>95 %</th></tr>"
        drawn = ""
        if "corrected" in last and len(self._steps("corrected.force_N")) > 1:
            drawn = inline(lambda ax: self.plot(ax=ax))
        return f"<p>{html.escape(repr(self)[1:-1])}</p><table>{head}{rows}</table>{drawn}"


def _program() -> str:
    """The file of what computes: a sweep goes on only with the same."""
    return str(_core.__file__)


def _of_text(name: str, keys: list[str], table: bytes) -> SweepTable:
    return SweepTable(_core.SweepTable.parse(name, keys, table))


def _written(path: PathLike, write: Callable[[Path], object]) -> None:
    """Writes a file under another name, then gives it its own."""
    import tempfile

    target = Path(path)
    try:
        with tempfile.TemporaryDirectory(prefix=".gelbench-new-", dir=target.parent) as folder:
            aside = Path(folder) / target.name
            write(aside)
            os.replace(aside, target)
    except OSError as cause:
        raise WriteError(f"{target} cannot be written: {cause}") from cause


class SweepPlan:
    """The runs of a sweep, which are computed here, or in parts by other processes and machines.

    Plans can be pickled; the files that a study names, such as cards, must be where they are for whoever computes.

    Parameters
    ----------
    study, parameters, points, fit, samples, method, seed, factors, allow_large
        As of `sweep`.

    Examples
    --------
    With a cluster of ``dask.distributed``, which computes parts of lost workers again:

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
        if isinstance(study, (Plate, Specimen)):
            path, text, files = study._in_memory(factors)
        else:
            if factors is not None:
                raise fault("factors", "a study file has its own", "vary its keys, such as load.stretches.0")
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
        varied, columns = _varied(parameters), _columns(points)
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
        """What is set in each run, by keys with their units."""
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
        """Computes one part of so many, and writes nothing: a function for schedulers such as Dask.

        Parameters
        ----------
        part : int
            The part, from 1.
        parts : int
            How many there are; with ``len(plan)`` each is one run.
        """
        return self.run(shard=(part, parts))

    def join(self, tables: Iterable[SweepTable]) -> SweepTable:
        """The tables of all parts as one, the same as of one `run`.

        Raises
        ------
        gelbench.InputError
            Where they are not the parts of this plan, or some are missing.
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
    """Computes a study many times, some of its keys changed, as ``gelbench sweep`` does.

    Parameters
    ----------
    study : str, path, Plate or Specimen
        A study file, or a problem.
    parameters : mapping
        Values by keys, whose parts have dots between them: ``plate.thickness``, ``material.c10``, ``load.stretches.0``. A text is
        what stands behind ``--vary KEY=``: ``"0.04..0.06 MPa:20"`` a grid, ``"1 mm,2 mm"`` values, ``"45..55 mm"`` a uniform and
        ``"0.05+-0.002 MPa"`` a normal distribution. A list or an array has the values themselves, with units where the study has
        them: ``["1 mm", "2 mm"]``, or quantities of pint. Every combination is run.
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
        Load factors of a plate or specimen, as in `Plate.solve`; a study file has its own.
    allow_large : bool
        Whether to let pass what needs more than a common machine has.

    Returns
    -------
    SweepTable
        A row for each run, in the order of their numbers.

    Raises
    ------
    gelbench.InputError
        With every fault of the study and of what is varied. A run without a solution is none: it stands in `SweepTable.faults`.
    gelbench.WriteError
        Where files cannot be written.

    Notes
    -----
    Runs are computed beside one another, other Python threads go on meanwhile, and Ctrl-C stops the computation.

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
