"""Problems as studies, solved by one model or compared in all three; and study files."""

from __future__ import annotations

import copy
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import InputError, SolveError, WriteError, fault
from ._material import Material, in_memory, on_disk, shipped
from ._material import card as core_card
from ._material import material as _material
from ._progress import Progress, callback
from ._quantities import PathLike, finite, floats, magnitudes, number, text
from ._results import Results
from ._solution import Solution

__all__ = ["Factors", "Files", "Model", "Settings", "StudyInMemory", "check", "factor_texts", "merged", "run"]

Model: TypeAlias = Literal["corrected", "mass-spring", "finite-element"]
Factors: TypeAlias = "ArrayLike | Sequence[float | str]"
Settings: TypeAlias = "Mapping[str, Any]"
"""Keys of a study, by section where they have one."""

Files: TypeAlias = "dict[str, bytes]"
"""Objects in memory, by the names used in a study."""

TEXTS = ("shape", "lattice", "file", "file_unit")
"""Keys of a sheet that are no quantities."""


def _unit(dimension: str) -> str:
    return "rad" if dimension == "angle" else "mm"


class StudyInMemory:
    """A study that is solved."""

    material: Material
    _sections: dict[str, Any]
    _mesh: _core.GivenMesh | None = None
    _section: str
    """The section of a study that states the sheet."""

    def __getattr__(self, name: str) -> Any:
        # Dimensions are numbers: mm, rad of an angle.
        own = self._dimensions()
        if name not in own:
            raise AttributeError(f"a {type(self).__name__} has no attribute {name}; it has {', '.join(['material', *own])}")
        value = own[name]
        if isinstance(value, list):
            return tuple(value)
        return number(value, _unit(name), name) if isinstance(value, str) and name not in TEXTS else value

    def __copy__(self) -> StudyInMemory:
        made = type(self).__new__(type(self))
        made.__dict__.update(self.__dict__, _sections=copy.deepcopy(self._sections))
        return made

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "material":
            value = _material(value)
        elif not name.startswith("_"):
            own = self._dimensions()
            if not isinstance(own.get(name), str) or name in TEXTS:
                kind = type(self).__name__
                if name not in own:
                    raise AttributeError(f"a {kind} has no attribute {name}; it has {', '.join(['material', *own])}")
                raise AttributeError(f"{name} of a {kind} cannot be assigned; create another {kind} with it")
            before, own[name] = own[name], text(value, _unit(name), name)
            try:
                self._check()
            except InputError:
                own[name] = before
                raise
            return
        super().__setattr__(name, value)

    def _unit_of(self, key: str) -> str:
        """The unit that a plain number of a key is in; empty where it needs none, or where it is not known."""
        section, _, name = key.partition(".")
        if section == "material" and name in self.material.parameters:
            return self.material.parameters[name].unit.strip("–")
        is_dimension = section == self._section and isinstance(self._dimensions().get(name), str) and name not in TEXTS
        return _unit(name) if is_dimension else ""

    def _dimensions(self) -> dict[str, Any]:
        sections: dict[str, Any] = self.__dict__.get("_sections", {})
        found: dict[str, Any] = sections.get(self._section, {})
        return found

    def _check(self) -> None:
        """Raises at once what is wrong with the study."""
        study, files = self._here(None)
        _core.check_sheet(study, files, self._mesh)

    def study(self, factors: Factors | None = None, *, card: PathLike | None = None) -> str:
        """The text of the study, which ``gelbench run`` computes with bit-identical results.

        Parameters
        ----------
        factors : array_like, optional
            As in `solve`.
        card : str or path, optional
            The ``.toml`` file that the text names as the material's card, relative to the study, such as one of `Material.save`. By
            default the card that the material was read from.

        Raises
        ------
        gelbench.InputError
            If the material is not in a file, or its file has changed since: `write_study` writes both. A mesh in memory must be saved and named by `specimen.file` in the text.
        """
        if card is None:
            return self._text(factors, on_disk(self.material))
        name = os.fspath(card)
        if not name.endswith(".toml"):
            raise fault("card", f"is {name!r}", "give the path of a .toml file")
        return self._text(factors, name)

    def write_study(self, path: PathLike, factors: Factors | None = None) -> list[Path]:
        """Writes the study for the command, and the material's card beside it.

        Parameters
        ----------
        path : str or path
            The file, such as ``plate.toml``; its card is then ``plate-card.toml``, and none is written if
            the card is shipped with gelbench.
        factors : array_like, optional
            As in `solve`.

        Returns
        -------
        list of pathlib.Path
            The files.

        Raises
        ------
        gelbench.InputError
            If the mesh is in memory.
        gelbench.WriteError
            If a file cannot be written.
        """
        self._refuse_meshes_in_memory()
        target = Path(path)
        name = shipped(self.material)
        beside = target.with_name(f"{target.stem}-card.toml")
        study = self._text(factors, name or beside.name)
        if name is None:
            self.material.save(beside)
        try:
            target.write_text(study, encoding="utf-8")
        except OSError as cause:
            raise WriteError(f"{target} cannot be written: {cause}") from cause
        return [target] if name else [target, beside]

    def _text(self, factors: Factors | None, card: str) -> str:
        raise NotImplementedError

    def _here(self, factors: Factors | None) -> tuple[str, Files]:
        """The text of the study as it is computed here, and what it names and is in memory."""
        name, files = in_memory(self.material)
        return self._text(factors, name), files

    def _in_memory(self, factors: Factors | None) -> tuple[str, str, Files]:
        """Name and text of the study, and the files that the text names and no disk has."""
        self._refuse_meshes_in_memory()
        return type(self).__name__.lower(), *self._here(factors)

    def _refuse_meshes_in_memory(self) -> None:
        if self._mesh is not None:
            raise fault("study", "its mesh is on no disk", "save the mesh, and give a study that names the file")

    def _one(self, study: str, files: Files, model: str, progress: Any, allow_large: bool) -> _core.Solution:
        if not isinstance(model, str):
            raise fault("model", f"is {model!r}", 'give "corrected", "mass-spring" or "finite-element"')
        return _core.solve_sheet(study, core_card(self.material), files, model, self._mesh, progress, allow_large)

    def _all(self, study: str, files: Files, progress: Any, allow_large: bool) -> _core.Results:
        return _core.run_sheet(study, core_card(self.material), files, self._mesh, progress, allow_large)

    def solve(
        self,
        model: Model = "corrected",
        factors: Factors | None = None,
        *,
        reference: bool = False,
        progress: Progress | None = None,
        allow_large: bool = False,
    ) -> Solution:
        """Solves one model.

        Parameters
        ----------
        model : {"corrected", "mass-spring", "finite-element"}
            The model. Finite elements are those of the finest mesh of the study.
        factors : array_like, optional
            Load factors, from small to large (of a compressed plate from -0.05 to -0.1); of a plate the displacement of the grip over the length: 0.5, or ``"50 %"``, is a stretch to
            150 %.
        reference : bool
            Whether to solve all models, so that `State.error` is known.
        progress : callable or tqdm bar, optional
            Receives a line of text for each step, from another thread.
        allow_large : bool
            Whether to allow computations beyond a common machine.

        Returns
        -------
        Solution
            One state for each load factor.

        Raises
        ------
        gelbench.InputError
            With every fault of the problem.
        gelbench.SolveError
            If a load factor is not reached; its `solution` contains the others.

        Notes
        -----
        Other Python threads continue meanwhile, and Ctrl-C stops the computation. Warnings, such as a stretch beyond the range
        of the card, are in `Solution.warnings`. A single model does not store the load history: a softening material is
        refused, use `run`.
        """
        study, files = self._here(factors)
        told = callback(progress)
        core = self._one(study, files, model, told, allow_large)
        errors = self._errors(study, files, model, told, allow_large) if reference else {}
        solution = Solution(core, model, errors)
        if core.ends:
            error = core.ends[0]
            if isinstance(error, SolveError):
                error.load_factor = next((one for one in self._wanted(study) if one not in core.factors()), None)
                error.solution = solution
            raise error
        return solution

    def run(
        self,
        factors: Factors | None = None,
        *,
        progress: Progress | None = None,
        allow_large: bool = False,
    ) -> Results:
        """Solves all three models and compares them, as the command does.

        Parameters
        ----------
        factors, progress, allow_large
            As in `solve`.

        Returns
        -------
        Results
            Figures, requirements, warnings, fields and pictures.
        """
        return Results(self._all(*self._here(factors), callback(progress), allow_large))

    def _errors(
        self, study: str, files: Files, model: str, told: Any, allow_large: bool
    ) -> dict[float, dict[str, float]]:
        results = Results(self._all(study, files, told, allow_large))
        key = model.replace("-", "_")
        steps: list[dict[str, Any]] = results.json["steps"]
        found: dict[float, dict[str, float]] = {}
        for step in steps:
            own = step.get(key) or {}
            percents = {name: own[name] for name in own if name.endswith("_percent") and own[name] is not None}
            found[float(step["at"])] = percents
        return found

    def _wanted(self, study: str) -> list[float]:
        line = next(line for line in study.splitlines() if line.startswith(("stretches", "factors")))
        listed = line.partition("[")[2].rpartition("]")[0].split(",")
        return [number(one.strip().strip('"'), "", "factors") for one in listed]


def factor_texts(factors: Factors | None, default: Sequence[float]) -> list[str]:
    """Load factors as a study has them."""
    given: Any = magnitudes(default if factors is None else factors, "factors")
    if isinstance(given, str) or np.ndim(given) == 0:
        given = [given]
    if not all(isinstance(one, str) for one in given):
        # A study takes either texts or numbers alone.
        plain = [number(one, "", "factors") if isinstance(one, str) else one for one in given]
        given = finite(floats(plain, "factors", (None,)), "factors")
    return [text(one, "", "factors") for one in given]


def merged(
    sections: dict[str, Any], settings: Settings | None, arguments: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """Sections with further keys; those that `arguments` say are refused with what is told there."""
    found = {name: dict(own) if isinstance(own, Mapping) else own for name, own in sections.items()}
    if not isinstance(settings or {}, Mapping):
        raise fault("settings", f"is {settings!r}", 'give keys by section, such as {"corrector": {"scheme": "gauss"}}')
    for name, own in (settings or {}).items():
        keys = [name, *(f"{name}.{key}" for key in own)] if isinstance(own, Mapping) else [name]
        for key in keys:
            if key in (arguments or {}):
                raise fault(f"settings.{key}", "is set by an argument", (arguments or {})[key])
        found[name] = {**found.get(name, {}), **own} if isinstance(own, Mapping) else own
    return found


def _study_path(path: PathLike) -> str:
    """The path of a study."""
    try:
        return os.fspath(path)
    except TypeError:
        raise fault("path", f"is {path!r}", "give the path of a study; a Plate or a Specimen has its own run") from None


def run(path: PathLike, *, progress: Progress | None = None, allow_large: bool = False) -> Results:
    """Computes a study file of any kind, as ``gelbench run`` does; nothing is written.

    Parameters
    ----------
    path : str or path
        The study.
    progress : callable or tqdm bar, optional
        Receives a line of text for each step, from another thread.
    allow_large : bool
        Whether to allow computations beyond a common machine.

    Returns
    -------
    Results
        All results of the command; `Results.write` writes its files.

    Raises
    ------
    gelbench.InputError
        With every fault of the study.
    gelbench.SolveError
        If no model has any solution.
    """
    return Results(_core.run(_study_path(path), callback(progress), allow_large))


def check(path: PathLike, *, allow_large: bool = False) -> tuple[str, list[str]]:
    """Reads a study file of any kind without computing it, as ``gelbench check`` does.

    Returns
    -------
    about : str
        What it will compute.
    warnings : list of str
        Warnings.

    Raises
    ------
    gelbench.InputError
        With every fault of the study.
    """
    return _core.check(_study_path(path), allow_large)
