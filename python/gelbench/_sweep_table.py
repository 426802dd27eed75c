"""Results of many runs of a study."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Callable, Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import WriteError, fault
from ._plots import band_over_steps, inline
from ._quantities import Floats, PathLike

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

__all__ = ["Band", "Column", "SweepTable"]

Column: TypeAlias = "Floats | list[str]"
"""Numbers, or texts such as names of cards."""


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
    """Number of runs that have the figure at each step."""


class SweepTable:
    """Results of many runs of a study: one row for each.

    ``table["corrected.force_N@0.5"]`` is a column: figures are named by model, quantity with its unit, and the step, and are
    NaN where a run has none; what was varied is found by its key, with or without the unit. ``in`` and loops take names of columns,
    ``len`` is the number of runs. Arrays are read-only, take a copy to change one. Tables can be pickled.
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
        """Values set in each run, by keys with their units: numbers as arrays, others as lists of texts."""
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
        """Whether each run meets all requirements of the study."""
        return self._core.passed()

    @property
    def faults(self) -> list[str]:
        """Why a run has no solution, or where a model ended early; otherwise an empty text."""
        return self._core.faults()

    @property
    def run_warnings(self) -> list[str]:
        """Warnings of each run, as in ``sweep.csv``, separated by `` | ``."""
        return self._core.run_warnings()

    @property
    def files(self) -> list[Path]:
        """The files that were written."""
        return [Path(path) for path in self._core.files]

    @property
    def warnings(self) -> list[str]:
        """Warnings: pictures that could not be drawn, and the warnings of the runs, each once."""
        return self._core.warnings

    def __getitem__(self, name: str) -> Any:
        if name in self.figures:
            return self.figures[name]
        for (head, values), key in zip(self.settings.items(), self.keys, strict=True):
            if name in (head, key):
                return values
        return self.columns[name]

    def __contains__(self, name: object) -> bool:
        return name in self.columns or name in self.keys

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

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
            The n steps: stretches, load factors, or times [s]; ascending, or one after another where some are repeated.
        values : ndarray
            The figure, runs × n.
        """
        at, names = self._steps(figure)
        return at, np.column_stack([self.figures[name] for name in names])

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
        at, names = self._steps(figure)
        own = [self.statistics[name] for name in names]
        low, median, high = np.array([one["quantiles_5_50_95_percent"] for one in own], dtype=np.float64).T
        return Band(at, low, median, high, np.array([one["runs"] for one in own]))

    def _steps(self, figure: str) -> tuple[Floats, list[str]]:
        """The steps of a figure, and its name at each."""
        split = [(name, *name.rpartition("@")[::2]) for name in self.figures]
        found = [(at, name) for name, own, at in split if own == figure]
        if not found:
            known = sorted({own for _, own, _ in split})
            raise fault("figure", f"there is no figure `{figure}`", f"figures are {', '.join(known)}")
        # A history comes to some steps again: `0.3#2`.
        if not any("#" in at for at, _ in found):
            found.sort(key=lambda one: float(one[0]))
        return np.array([float(at.partition("#")[0]) for at, _ in found]), [name for _, name in found]

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
            If it cannot be written; a partial file is never left.
        """
        _written(path, lambda place: place.write_bytes(self._core.csv()))

    def to_parquet(self, path: PathLike) -> None:
        """Writes the table as Parquet, with pyarrow; figures missing in a run are null.

        Raises
        ------
        gelbench.WriteError
            If it cannot be written; a partial file is never left.
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
        if "corrected" in last and len(self._steps("corrected.force_N")[1]) > 1:
            drawn = inline(lambda ax: self.plot(ax=ax))
        return f"<p>{html.escape(repr(self)[1:-1])}</p><table>{head}{rows}</table>{drawn}"


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
