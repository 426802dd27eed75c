"""Plates and specimens that move in time."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _core
from ._errors import fault
from ._material import Material, in_memory, viscosity_sections
from ._plate import Plate
from ._progress import Progress, callback
from ._quantities import Quantity, number, text, texts, toml
from ._results import Results
from ._specimen import Specimen
from ._study import Files, Settings, merged

__all__ = ["Motion"]

UNITS = {"amplitude": "", "frequency": "Hz", "to": "", "begin": "s", "end": "s", "time": "s", "stretches": "", "factors": "", "times": "s"}
"""Units of plain numbers of a drive."""

DEFAULTS: dict[Any, dict[str, Any]] = {"release": {"time": 0.0}, "ramp": {"begin": 0.0}}
"""What a drive begins with where it says nothing else."""

ARGUMENTS = {
    "kind": "it is that of a motion",
    "plate": "give a Plate",
    "specimen": "give a Specimen",
    "support": "give a Specimen with supports=",
    "load": "give a Specimen with loads=",
    "start": "give it as start=",
    "grip": "give it as drive=",
    "path": "give it as drive=",
    "gravity": "give it as gravity=",
    "probe": "give them as probes=",
    "time.duration": "give it as duration=",
    "time.interval": "give it as interval=",
    "material.density": "give it as density=",
    "material.viscosity": "give it as viscosity=",
}
"""Settings that are arguments, and the remedy."""

OF_EQUILIBRIA = ("load", "path", "mass_spring", "corrector", "finite_element", "tolerances", "pictures", "models")
"""Sections of a sheet's equilibria that a motion does not take over."""


class Motion:
    """A plate or a specimen that moves in time: grips or loads that are held, driven or released, with inertia and viscosity.

    Parameters
    ----------
    sheet : Plate or Specimen
        The sheet, with its material, supports and loads.
    duration : quantity
        How long it moves [s].
    start : quantity
        The stretch of a plate, or the load factor of a specimen, at which the sheet was held before.
    drive : mapping
        ``{"motion": "hold"}``, ``{"motion": "release"}``, ``{"motion": "ramp", "to": 0.5, "end": 0.1}``,
        ``{"motion": "sine", "amplitude": 0.05, "frequency": 2}``, or ``{"motion": "table", "times": […], "stretches": […]}`` of a plate and
        ``"factors"`` of a specimen; plain numbers are ratios, s and Hz.
    interval : quantity, optional
        Time between the instants of the results [s]; a hundredth of the duration if omitted.
    density : quantity, optional
        Such as ``"1020 kg/m^3"``, if the card has none.
    viscosity : mapping, optional
        Instead of the card's: ``{"shear": "50 Pa*s"}``, ``{"relaxation": [{"share": 0.3, "time": "2 s"}]}``, or both.
    gravity : tuple of quantity, optional
        Acceleration in the plane of the sheet [mm/s²], such as ``(0, "-9.81 m/s^2")``.
    probes : mapping, optional
        Points at rest by name [mm], whose displacement and velocity are reported.
    settings : mapping, optional
        Other keys of a study, by section, such as ``{"time": {"integrator": "generalised-alpha"}, "corrector": {"enabled": False}}``.

    Raises
    ------
    gelbench.InputError
        With every fault.

    Examples
    --------
    >>> plate = gb.Plate(length=150, width=50, thickness=2, material="pva-10", cells=(30, 10))
    >>> motion = gb.Motion(plate, "0.1 s", start=0.1, drive={"motion": "release"}, density="1020 kg/m^3")
    >>> results = motion.run()
    """

    def __init__(
        self,
        sheet: Plate | Specimen,
        duration: Quantity,
        *,
        start: Quantity = 0.0,
        drive: Mapping[str, Any],
        interval: Quantity | None = None,
        density: Quantity | None = None,
        viscosity: Mapping[str, Any] | None = None,
        gravity: Sequence[Quantity] | None = None,
        probes: Mapping[str, Sequence[Quantity]] | None = None,
        settings: Settings | None = None,
    ) -> None:
        if not isinstance(sheet, (Plate, Specimen)):
            raise fault("sheet", f"is {sheet!r}", "give a Plate or a Specimen")
        if sheet._mesh is not None:
            raise fault("sheet", "its mesh is on no disk", "save the mesh, and name its file in a study for gelbench.run")
        if not isinstance(drive, Mapping):
            raise fault("drive", f"is {drive!r}", 'give a mapping, such as {"motion": "release"}')
        self._sheet = copy.deepcopy(sheet)
        self._material = sheet.material
        length = text(duration, "s", "duration")
        own: dict[str, Any] = {
            "kind": "motion",
            "material": {} if density is None else {"density": text(density, "kg/m^3", "density")},
            "time": {"duration": length, "interval": _hundredth(length) if interval is None else text(interval, "s", "interval")},
            "probe": [{"name": name, "at": [text(one, "mm", "probes") for one in at]} for name, at in _points_by_name(probes)],
        }
        if gravity is not None:
            if isinstance(gravity, str) or np.ndim(np.asarray(gravity, dtype=object)) != 1 or len(gravity) != 2:
                raise fault("gravity", f"is {gravity!r}", 'give its components along x and y, such as (0, "-9.81 m/s^2")')
            x, y = gravity
            own["gravity"] = {"x": text(x, "mm/s^2", "gravity"), "y": text(y, "mm/s^2", "gravity")}
        own |= _of_sheet(sheet, text(start, "", "start"), texts({**DEFAULTS.get(drive.get("motion"), {}), **drive}, UNITS, "drive"))
        own |= viscosity_sections(viscosity, "material.viscosity")
        self._sections = merged(own, settings, ARGUMENTS)
        study, files = self._here()
        _core.check("motion", False, study, files)

    @property
    def sheet(self) -> Plate | Specimen:
        """The sheet; another one needs another Motion."""
        return copy.deepcopy(self._sheet)

    @property
    def material(self) -> Material:
        """The material of the sheet."""
        return self._material

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            raise AttributeError(f"{name} of a Motion cannot be assigned; create another Motion with it")
        super().__setattr__(name, value)

    def _here(self) -> tuple[str, Files]:
        name, files = in_memory(self.material)
        sections = {**self._sections, "material": {"card": name, **self._sections["material"]}}
        return toml({key: value for key, value in sections.items() if value}), files

    def study(self) -> str:
        """The text of the study, which ``gelbench run`` computes with bit-identical results; it names the card as `Material.save` may
        write it beside the study."""
        return self._here()[0]

    def run(self, *, progress: Progress | None = None, allow_large: bool = False) -> Results:
        """Computes the motion of springs, corrected springs and finite elements.

        Parameters
        ----------
        progress, allow_large
            As of `Plate.solve`.

        Returns
        -------
        Results
            Tables over time, requirements, warnings, fields at every instant and pictures.

        Raises
        ------
        gelbench.SolveError
            If a model has no solution.
        """
        study, files = self._here()
        return Results(_core.run("motion", callback(progress), allow_large, study, files))

    def __repr__(self) -> str:
        return f"<gelbench.Motion of {self._sections['time']['duration']}: {self._sheet!r}>"


def _of_sheet(sheet: Plate | Specimen, start: str, drive: dict[str, Any]) -> dict[str, Any]:
    """The sections of a motion that state the sheet, its start and its drive."""
    kept = {name: own for name, own in sheet._sections.items() if name not in OF_EQUILIBRIA}
    if isinstance(sheet, Plate):
        return {**kept, "start": {"stretch": start}, "grip": drive}
    conditions = {name: own for name, own in sheet._conditions.items() if own}
    path = {**drive, "measured_group": sheet._measured}
    return {**kept, **conditions, "start": {"factor": start}, "path": path}


def _points_by_name(probes: Mapping[str, Sequence[Quantity]] | None) -> list[tuple[str, Sequence[Quantity]]]:
    if not isinstance(probes or {}, Mapping):
        raise fault("probes", f"is {probes!r}", 'give points by name, such as {"middle": (75, 25)}')
    return list((probes or {}).items())


def _hundredth(duration: str) -> str:
    return f"{number(duration, 's', 'duration') / 100!r} s"
