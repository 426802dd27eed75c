"""From test curves to laws, and from recordings to springs and dashpots."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import InputError, fault
from ._material import Material
from ._plots import image
from ._progress import Progress, callback
from ._quantities import Floats, PathLike, Quantity, SupportsUnits, array_of, floats, number, text, whole

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
    """Standard error, or None."""
    interval: tuple[float, float] | None
    """95 % interval, or None."""


UNITS_OF_COLUMNS = ("", "MPa", "mm", "N", "s")
"""Units for a column of pint quantities whose header states none; the first that fits is used."""


def _column(head: str, column: Any) -> tuple[str, Any]:
    """Head and values of a column: quantities of pint in the unit of the head, masked entries as NaN."""
    argument = f"data.{head}"
    if not isinstance(column, SupportsUnits):
        own = np.ma.filled(column.astype(np.float64), np.nan) if np.ma.isMaskedArray(column) else np.asarray(column)
        return head, own
    if head.endswith("]"):
        return head, array_of(column, argument, head.rpartition("[")[2].rstrip("]"), missing=True)
    for unit in UNITS_OF_COLUMNS:
        try:
            return f"{head} [{unit or '-'}]", array_of(column, argument, unit, missing=True)
        except InputError:
            continue
    raise fault(argument, "has a unit that does not suit any column", f"give one of {', '.join(UNITS_OF_COLUMNS[1:])}")


def _of_array(data: Any, columns: Sequence[str]) -> dict[str, Any]:
    """The columns of an array; its unit, if any, applies to all of them."""
    units = {column.partition("[")[2].rstrip("]") for column in columns}
    if isinstance(data, SupportsUnits) and len(units) > 1:
        raise fault("data", "is one array with one unit", f"give a mapping of columns, such as {columns[0]} and {columns[1]}")
    array = floats(data, "data", (None, len(columns)), units.pop(), missing=True)
    return {column: array[:, number] for number, column in enumerate(columns)}


def _table(data: Data, name: str, columns: Sequence[str]) -> tuple[str, str]:
    """Name and text of a table."""
    if isinstance(data, (str, os.PathLike)):
        path = Path(data)
        try:
            return os.fspath(path), path.read_text(encoding="utf-8-sig")
        except (OSError, UnicodeError) as cause:
            raise fault("data", f"{path} cannot be read: {cause}", "give a table in UTF-8") from None
    if hasattr(data, "items") and hasattr(data, "keys"):
        named = dict(_column(str(key), own) for key, own in data.items())
        lengths = {key: len(own) for key, own in named.items() if own.ndim == 1}
        if len(set(lengths.values())) != 1 or len(lengths) != len(named):
            raise fault("data", f"has columns of the lengths {lengths}", "give columns of one length")
    else:
        named = _of_array(data, columns)
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
        """All figures, as ``gelbench materials fit`` writes it."""
        self.material = Material._of(own)
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
        """Covariance of the parameters, n × n; NaN if there is none."""
        errors = np.array([one.standard_error for one in self.parameters.values()], dtype=np.float64)
        return self.correlation * np.outer(errors, errors)

    @property
    def verdict(self) -> str | None:
        """Nature of the residuals: ``white noise``, ``correlated noise``, ``systematic`` (no intervals), ``rounding`` (likewise)."""
        found: Mapping[str, Any] | None = self.json["verdict"]
        return None if found is None else str(found["answer"])

    @property
    def rmse(self) -> float:
        """Root mean square of the residuals [MPa]."""
        return float(self.json["rmse_MPa"])

    @property
    def warnings(self) -> list[str]:
        """Warnings."""
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
        return f"<b>{self.law}</b>: {self.verdict}<table>{head}{rows}</table>{image(self._picture)}"


def _pair(values: Sequence[float | None] | None) -> tuple[float, float] | None:
    if values is None or values[0] is None or values[1] is None:
        return None
    return (float(values[0]), float(values[1]))


def fit(
    data: Data,
    law: str | None,
    *,
    name: str = "fitted",
    test: str | Sequence[str] | None = None,
    stress: str | Sequence[str] | None = None,
    strain: str | Sequence[str] | None = None,
    stress_unit: str | Sequence[str] | None = None,
    strain_unit: str | Sequence[str] | None = None,
    weighting: str = "absolute",
    bounds: Mapping[str, tuple[Quantity, Quantity]] | None = None,
    fixed: Mapping[str, Quantity] | None = None,
    starts: int = 8,
    relaxation: bool | int = False,
    softening: bool = False,
    columns: tuple[str, str] | str | None = None,
    progress: Progress | None = None,
    **reading: Quantity | Sequence[Quantity],
) -> Fit:
    """Fits a law to test data.

    Parameters
    ----------
    data : path, DataFrame, mapping or array_like
        A test, or a list of tests that are fitted together. Heads name the columns with their units, such as
        ``"nominal strain [-]"`` and ``"nominal stress [MPa]"``; of an array n × 2 they are `columns`. Rows with NaN and masked
        entries are left out; columns of pint are converted.
    law : str or None
        Name of the law (see `gelbench.laws`); None selects the best of all.
    name : str
        Name of the material.
    test : {"uniaxial", "planar", "equibiaxial", "biaxial"}, optional
        The test, if the data do not state it. For several tests this, and anything else the data do not state, may be a
        list with one entry for each: ``test=["uniaxial", "planar"]``.
    stress : {"nominal", "cauchy"}, optional
        Measure of stress, if the data do not state it.
    strain : {"stretch", "nominal", "logarithmic"}, optional
        Measure of deformation, if the data do not state it.
    stress_unit, strain_unit : str, optional
        Units, if the data do not state them.
    weighting : {"absolute", "relative"}
        Weighting of the residuals.
    bounds : mapping, optional
        Lower and upper limits of parameters by key [MPa, rad, or dimensionless]: ``{"c10": ("20 kPa", 0.06)}``.
    fixed : mapping, optional
        Parameters that are stated instead of fitted, in the same units: ``{"angle": "30 deg"}``.
    starts : int
        Number of starts that are optimised, 1 or more.
    relaxation : bool or int
        Also fits a Prony series, to tests with a column of times such as ``"time [s]"``: with the number of terms selected
        by AICc (True), or with this number. The law is that of long times.
    softening : bool
        Also fits softening by the largest previous load (Mullins effect), to loading and unloading. The law is that of the
        first loading.
    columns : tuple of str, or str
        Heads of an array's columns, deformation and stress by what is said of them if omitted; or, of a table in which several columns may be meant, those to read, such as
        ``"strain=Extension,stress=Load 2"``.
    progress : callable or tqdm bar, optional
        Receives progress messages.
    **reading : str or quantity
        Anything else the data do not state, by the keys of ``gelbench materials fit`` with ``_``: ``direction``,
        ``strain_ratio``, ``area`` [mm²], ``length``, ``width``, ``thickness`` [mm], ``time_unit``, ``cycle``, ``zero``, ``ramp``, ``specimen_name``;
        such as ``cycle="last"`` or ``area="8 mm^2"``.

    Returns
    -------
    Fit
        Parameters with intervals, the material, the verdict.

    Raises
    ------
    gelbench.InputError
        With all faults of the data; nothing is guessed.
    """
    several = isinstance(data, (list, tuple)) and len(data) > 0 and _are_tests(data)
    all_data = list(data) if several else [data]
    given: dict[str, Any] = {
        "test": test,
        "stress measure": stress,
        "strain measure": strain,
        "stress unit": stress_unit,
        "strain unit": strain_unit,
    }
    given |= {key.replace("_", " "): value for key, value in reading.items()}
    heads = _heads(strain, strain_unit, stress_unit) if columns is None or isinstance(columns, str) else columns
    if isinstance(columns, str):
        given["columns"] = columns
    said, of_each = _statements(given, len(all_data))
    named = [_table(one, f"{name} {place}", heads) for place, one in enumerate(all_data, 1)]
    tables = [(own, head + table) for (own, table), head in zip(named, of_each, strict=True)]
    history = _history(law, relaxation, softening)
    limits = [(key, _limits(key, pair)) for key, pair in (bounds or {}).items()]
    limits += [(key, [_limit(value, f"fixed.{key}")] * 2) for key, value in (fixed or {}).items()]
    least = whole(starts, "starts", 1)
    return Fit(_core.fit(tables, law, name, said, weighting, limits, least, history, callback(progress)))


def _heads(strain: Any, strain_unit: Any, stress_unit: Any) -> tuple[str, str]:
    """Heads of an array's two columns, by what is said of them."""
    measures = {strain} if strain is None or isinstance(strain, str) else set(strain)
    deformation = "stretch" if measures <= {None, "stretch"} else "strain"
    return deformation + (" [-]" if strain_unit is None else ""), "stress" + (" [MPa]" if stress_unit is None else "")


def biaxial(
    data: Data,
    law: str | None,
    *,
    mounting: str | None = None,
    rest_state: str | Sequence[float] = "as-mounted",
    force_zero: str = "as-measured",
    markers: Quantity | None = None,
    **more: Any,
) -> Fit:
    """Fits a law to planar biaxial tests of one specimen, as it is mounted.

    Parameters
    ----------
    data : path, DataFrame, mapping or array_like
        A test, or a list of protocols of one specimen: displacements and forces, or strains and stresses, along both axes.
    law : str or None
        Name of the law, such as ``"fung"`` or ``"holzapfel-gasser-ogden"``; None selects the best of all.
    mounting : {"rakes", "cruciform"}, optional
        What holds the sheet, which is then solved by finite elements with the law; homogeneous if omitted. Rakes have ``tines=``
        at each side, ``tine_spacing=``, ``tine_inset=`` from the edge and ``tine_diameter=`` [mm], and ``tine_bars="sliding"`` where tines or
        threads move along their bar; a cruciform has ``arm_width=`` and ``fillet=`` [mm].
    rest_state : str or pair of float
        The state without stress: ``"as-mounted"``, ``"estimated"`` with the law, or the stretches along both axes as mounted.
    force_zero : {"as-measured", "estimated"}
        The zeros of both forces.
    markers : quantity, optional
        The stretches are those of four markers at the corners of a square of this side in the middle [mm]; of the bars if omitted.
    **more
        Anything that `gelbench.fit` takes, such as ``length=``, ``width=``, ``thickness=`` [mm] as mounted, ``bounds=`` and ``fixed=``.

    Returns
    -------
    Fit
        ``.json["mounting"]`` has the homogeneous reading and its bias, ``.json["rest_state"]`` what was found of the state at rest.

    Examples
    --------
    >>> gb.biaxial("square.csv", "fung", mounting="rakes", tines=5, tine_spacing=1.5, tine_inset=1, tine_diameter=0.25,
    ...            length=8, width=8, thickness=0.8, rest_state="estimated")
    """
    if not isinstance(rest_state, str) and np.shape(rest_state) != (2,):
        raise fault("rest_state", f"is {rest_state!r}", 'give "as-mounted", "estimated", or the stretches along both axes as mounted')
    stretches = rest_state if isinstance(rest_state, str) else ",".join(str(float(one)) for one in rest_state)
    said: dict[str, Any] = {"test": "biaxial", "mounting": mounting, "markers": markers, "rest_state": stretches, "force_zero": force_zero}
    return fit(data, law, **{key: value for key, value in said.items() if value is not None}, **more)


def _history(law: str | None, relaxation: bool | int, softening: bool) -> str | None:
    """Extensions fitted on top of a law."""
    if softening and relaxation is not False:
        raise fault("softening", "relaxation and softening cannot be fitted together", "leave one of them out")
    if law is None and (softening or relaxation is not False):
        raise fault("law", "relaxation and softening are fitted on top of a law", 'name it, such as "yeoh"')
    if relaxation is not False:
        return "relaxation" if relaxation is True else str(relaxation)
    return "softening" if softening else None


LENGTHS = ("length", "width", "thickness", "tine spacing", "tine inset", "tine diameter", "arm width", "fillet", "markers")

PLAIN = {"area": "mm^2", "mass": "tonne", **{key: "mm" for key in LENGTHS}}
"""Units of plain numbers in statements about data."""


def _said(key: str, value: Any) -> str:
    """A statement about data as a text."""
    if isinstance(value, (str, bool)) or (key not in PLAIN and not isinstance(value, SupportsUnits)):
        return str(value)
    return text(value, PLAIN.get(key, ""), key)


def _statements(given: Mapping[str, Any], count: int) -> tuple[dict[str, str], list[str]]:
    """The statements about all tests, and the lines above the table of each."""
    said: dict[str, str] = {}
    heads = [""] * count
    for key, value in given.items():
        if value is None:
            continue
        if not isinstance(value, (list, tuple)):
            said[key] = _said(key, value)
            continue
        if len(value) != count:
            raise fault(key, f"has {len(value)} entries for {count} tests", "give one for each test, or one for all")
        for place, one in enumerate(value):
            heads[place] += "" if one is None else f"# {key}: {_said(key, one)}\n"
    return said, heads


def _limits(key: str, pair: Any) -> list[float]:
    """The limits of a parameter, which is a stress, an angle or a plain number."""
    argument = f"bounds.{key}"
    if isinstance(pair, str) or np.shape(np.asarray(pair, dtype=object)) != (2,):
        raise fault(argument, f"is {pair!r}", 'give the lower and the upper limit, such as (0.01, 0.1) or ("20 kPa", "60 kPa")')
    found = [_limit(one, argument) for one in pair]
    if not found[0] < found[1]:
        raise fault(argument, f"is {pair!r}", "the lower limit must be less than the upper one")
    return found


def _limit(value: Any, argument: str) -> float:
    if not isinstance(value, (str, SupportsUnits)):
        return float(array_of(value, argument))
    for unit in ("MPa", "rad", ""):
        with suppress(InputError):
            return number(value, unit, argument)
    raise fault(argument, f"is {value!r}", 'give a stress such as "20 kPa", an angle such as "30 deg", or a plain number')


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
        """All figures, as ``gelbench identify`` writes it."""

    @property
    def misfit(self) -> float:
        """1 if force, motion and forms are consistent."""
        return float(self.json["misfit"])

    @property
    def picture(self) -> bytes:
        """The functions with their bands, and the residuals of the signals, as a PNG."""
        return self._picture

    def __repr__(self) -> str:
        return f"<gelbench.Identification: misfit {self.misfit:.3g}>"

    def _repr_html_(self) -> str:
        return f"<p>misfit {self.misfit:.3g}</p>{image(self._picture)}"


def identify(
    data: Data,
    *,
    stiffness: str = "spline",
    damping: str = "spline",
    stiffness_shape: str = "free",
    damping_shape: str = "free",
    damping_over: str = "extension",
    mass: Quantity | None = None,
    length: Quantity | None = None,
    area: Quantity | None = None,
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
        Known shape of the functions.
    damping_over : {"extension", "rate"}
        Argument of D.
    mass, length, area : quantity, optional
        Mass that the force moves [tonne], length [mm] and cross-section [mm²] at rest, if the data do not state them; such as
        ``"20 g"``.
    columns : tuple of str
        Heads of an array's columns.
    progress : callable or tqdm bar, optional
        Receives progress messages.

    Raises
    ------
    gelbench.InputError
        If the recording does not determine the functions.
    """
    given = {"mass": mass, "length": length, "area": area}
    said = {key: _said(key, value) for key, value in given.items() if value is not None}
    table = _table(data, "recording", columns)
    forms, shapes = [stiffness, damping], [stiffness_shape, damping_shape]
    return Identification(_core.identify(table, said, forms, shapes, damping_over, callback(progress)))
