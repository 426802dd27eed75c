"""From test curves to laws, and from recordings to springs and dashpots."""

from __future__ import annotations

import base64
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import fault
from ._material import Material
from ._progress import Progress, callback
from ._quantities import Floats, PathLike, floats

__all__ = ["Estimate", "Fit", "Identification", "fit", "identify"]

Data: TypeAlias = Any
"""A file, a DataFrame, arrays by columns, or an array of two columns."""


class Estimate(NamedTuple):
    """A parameter with its uncertainty."""

    value: float
    """Value in `unit`."""
    unit: str
    """Unit; ``–`` for a plain number."""
    standard_error: float | None
    """Standard error; None where there is none."""
    interval: tuple[float, float] | None
    """95 % interval; None where there is none."""


def _table(data: Data, name: str, columns: Sequence[str]) -> tuple[str, str]:
    """Name and text of a table."""
    if isinstance(data, (str, os.PathLike)):
        path = Path(data)
        try:
            return os.fspath(path), path.read_text(encoding="utf-8-sig")
        except (OSError, UnicodeError) as cause:
            raise fault("data", f"{path} cannot be read: {cause}", "give a table in UTF-8") from None
    if hasattr(data, "items") and hasattr(data, "keys"):
        named = {str(key): np.asarray(own) for key, own in data.items()}
        lengths = {key: len(own) for key, own in named.items() if own.ndim == 1}
        if len(set(lengths.values())) != 1 or len(lengths) != len(named):
            raise fault("data", f"has columns of the lengths {lengths}", "give columns of one length")
    else:
        array = floats(data, "data", (None, len(columns)))
        named = {column: array[:, number] for number, column in enumerate(columns)}
    lines = [",".join(named)]
    for row in zip(*(own.tolist() for own in named.values()), strict=True):
        # All digits: numbers in memory do not say by how many they were rounded.
        lines.append(",".join(f"{one:.17g}" if isinstance(one, float) else str(one) for one in row))
    return name, "\n".join(lines) + "\n"


class Fit:
    """A law fitted to test data."""

    def __init__(self, found: tuple[str, _core.MaterialCard, bytes]) -> None:
        text, own, picture = found
        self._picture: bytes = picture
        self.json: dict[str, Any] = json.loads(text)
        """Everything in figures, as ``gelbench materials fit`` writes it."""
        self.material = Material(own)
        """The material."""

    @property
    def law(self) -> str:
        """Name of the law."""
        return str(self.json["law"])

    @property
    def parameters(self) -> dict[str, Estimate]:
        """Parameters with their uncertainty, by their keys."""
        return {
            one["key"]: Estimate(
                one["value"], one["unit"], one["standard_error"], _pair(one["interval_95_percent"])
            )
            for one in self.json["parameters"]
        }

    @property
    def correlation(self) -> Floats:
        """Correlation of the parameters, n × n."""
        return np.array(self.json["correlation"], dtype=np.float64)

    @property
    def covariance(self) -> Floats:
        """Covariance of the parameters, n × n; NaN where there is none."""
        errors = np.array([one.standard_error for one in self.parameters.values()], dtype=np.float64)
        return self.correlation * np.outer(errors, errors)

    @property
    def verdict(self) -> str | None:
        """What the law leaves of the data: ``white noise``, ``correlated noise``, ``systematic`` (no intervals), ``rounding`` (likewise)."""
        found: Mapping[str, Any] | None = self.json["verdict"]
        return None if found is None else str(found["answer"])

    @property
    def rmse(self) -> float:
        """Root of the mean square of the residuals [MPa]."""
        return float(self.json["rmse_MPa"])

    @property
    def warnings(self) -> list[str]:
        """What deserves attention."""
        return list(self.json["warnings"])

    @property
    def picture(self) -> bytes:
        """Data, fitted curve, band and residuals as a PNG."""
        return self._picture

    def __repr__(self) -> str:
        values = ", ".join(f"{key}={own.value:.5g}" for key, own in self.parameters.items())
        return f"<gelbench.Fit {self.law}: {values}; {self.verdict}>"

    def _repr_html_(self) -> str:
        def cell(own: Estimate) -> str:
            if own.interval is None:
                return f"{own.value:.5g}</td><td>"
            return f"{own.value:.5g}</td><td>{own.interval[0]:.5g} … {own.interval[1]:.5g}"

        rows = "".join(
            f"<tr><td>{key} [{own.unit}]</td><td>{cell(own)}</td></tr>" for key, own in self.parameters.items()
        )
        head = "<tr><th></th><th>value</th><th>95 % interval</th></tr>"
        return f"<b>{self.law}</b>: {self.verdict}<table>{head}{rows}</table>{_image(self._picture)}"


def _pair(values: Sequence[float] | None) -> tuple[float, float] | None:
    return None if values is None else (float(values[0]), float(values[1]))


def _image(png: bytes) -> str:
    return f'<img style="max-width:100%" src="data:image/png;base64,{base64.b64encode(png).decode()}">'


def fit(
    data: Data,
    law: str | None,
    *,
    name: str = "fitted",
    test: str | None = None,
    stress: str | None = None,
    strain: str | None = None,
    stress_unit: str | None = None,
    strain_unit: str | None = None,
    weighting: str = "absolute",
    bounds: Mapping[str, tuple[float, float]] | None = None,
    starts: int = 8,
    relaxation: bool | int = False,
    softening: bool = False,
    columns: tuple[str, str] = ("stretch [-]", "stress [MPa]"),
    progress: Progress | None = None,
    **reading: str,
) -> Fit:
    """Fits a law to test data.

    Parameters
    ----------
    data : path, DataFrame, mapping or array_like
        A test, or a list of tests that are fitted together. Heads name the columns with their units, such as
        ``"nominal strain [-]"`` and ``"nominal stress [MPa]"``; of an array n × 2 they are `columns`.
    law : str or None
        Name of the law (see `gelbench.laws`); None takes the best of all.
    name : str
        Name of the material.
    test : {"uniaxial", "planar", "equibiaxial", "biaxial"}, optional
        The test, where the data do not say it.
    stress : {"nominal", "cauchy"}, optional
        Measure of stress, where the data do not say it.
    strain : {"stretch", "nominal", "logarithmic"}, optional
        Measure of deformation, where the data do not say it.
    stress_unit, strain_unit : str, optional
        Units, where the data do not say them.
    weighting : {"absolute", "relative"}
        What residuals are measured by.
    bounds : mapping, optional
        Limits of parameters by key [MPa, or plain].
    starts : int
        Starts of the search that are improved.
    relaxation : bool or int
        A Prony series too, to tests with a column of times such as ``"time [s]"``: with as many terms as AICc asks for (True), or so
        many. The law is that of long times.
    softening : bool
        How the material softens by its largest load (Mullins effect), to loading and unloading. The law is that of the first
        loading.
    columns : tuple of str
        Heads of an array's columns.
    progress : callable or tqdm bar, optional
        Is told what is being done.
    **reading : str
        What else the data do not say, by the keys of ``gelbench materials fit`` with ``_``: ``direction``, ``strain_ratio``, ``area``,
        ``length``, ``width``, ``thickness``, ``time_unit``, ``cycle``, ``zero``, ``ramp``; such as ``cycle="last"`` or
        ``area="8 mm^2"``.

    Returns
    -------
    Fit
        Parameters with intervals, the material, the verdict.

    Raises
    ------
    gelbench.InputError
        With what is wrong with the data; nothing is guessed.
    """
    several = isinstance(data, (list, tuple)) and len(data) > 0 and not np.isscalar(data[0]) and _are_tests(data)
    all_data = list(data) if several else [data]
    tables = [_table(one, f"{name} {number}", columns) for number, one in enumerate(all_data, 1)]
    given = {
        "test": test,
        "stress measure": stress,
        "strain measure": strain,
        "stress unit": stress_unit,
        "strain unit": strain_unit,
    }
    said = {key: value for key, value in given.items() if value is not None}
    said |= {key.replace("_", " "): value for key, value in reading.items()}
    if softening and relaxation is not False:
        raise fault("softening", "relaxation and softening are fitted apart", "leave one of them out")
    if law is None and (softening or relaxation is not False):
        raise fault("law", "relaxation and softening are fitted on top of a law", "name it, such as \"yeoh\"")
    history: str | None = None
    if softening:
        history = "softening"
    elif relaxation is True:
        history = "relaxation"
    elif relaxation is not False:
        history = str(relaxation)
    limits = [(key, [float(low), float(high)]) for key, (low, high) in (bounds or {}).items()]
    return Fit(_core.fit(tables, law, name, said, weighting, limits, starts, history, callback(progress)))


def _are_tests(data: Any) -> bool:
    return all(isinstance(one, (str, os.PathLike)) or hasattr(one, "keys") or np.ndim(one) == 2 for one in data)


class Identification:
    """Spring and dashpot functions K(·) and D(·) found in a recording."""

    def __init__(self, found: tuple[str, str, bytes]) -> None:
        text, law, picture = found
        self.law: str = law
        """The functions as TOML, as ``gelbench identify`` writes them."""
        self._picture: bytes = picture
        self.json: dict[str, Any] = json.loads(text)
        """Everything in figures, as ``gelbench identify`` writes it."""

    @property
    def misfit(self) -> float:
        """1 where force, motion and forms fit together."""
        return float(self.json["misfit"])

    @property
    def picture(self) -> bytes:
        """The functions with their bands, and what is left of the signals, as a PNG."""
        return self._picture

    def __repr__(self) -> str:
        return f"<gelbench.Identification: misfit {self.misfit:.3g}>"

    def _repr_html_(self) -> str:
        return f"<p>misfit {self.misfit:.3g}</p>{_image(self._picture)}"


def identify(
    data: Data,
    *,
    stiffness: str = "spline",
    damping: str = "spline",
    stiffness_shape: str = "free",
    damping_shape: str = "free",
    damping_over: str = "extension",
    mass: str | None = None,
    length: str | None = None,
    area: str | None = None,
    columns: tuple[str, str, str] = ("time [s]", "extension [mm]", "force [N]"),
    progress: Progress | None = None,
) -> Identification:
    """Finds the functions K(·) and D(·) of a spring and a dashpot in a recording of force and motion.

    Parameters
    ----------
    data : path, DataFrame, mapping or array_like
        The recording: a table with the columns ``time``, ``extension`` (or ``length``, ``stretch``) and ``force`` with their units;
        of an array n × 3 they are `columns`.
    stiffness, damping : str
        Forms: ``"spline"``, ``"constant"``, ``"polynomial-3"`` and the like.
    stiffness_shape, damping_shape : {"free", "increasing", "decreasing"}
        What is known of the functions.
    damping_over : {"extension", "rate"}
        What D is a function of.
    mass, length, area : str, optional
        Mass that the force moves, length and cross-section at rest, with units, where the data do not say them.
    columns : tuple of str
        Heads of an array's columns.
    progress : callable or tqdm bar, optional
        Is told what is being done.

    Raises
    ------
    gelbench.InputError
        Where the recording does not determine the functions.
    """
    given = {"mass": mass, "length": length, "area": area}
    said = {key: value for key, value in given.items() if value is not None}
    table = _table(data, "recording", columns)
    forms, shapes = [stiffness, damping], [stiffness_shape, damping_shape]
    return Identification(_core.identify(table, said, forms, shapes, damping_over, callback(progress)))
