"""Solutions and results outside of the process that computed them: in pickles and files."""

from __future__ import annotations

import copyreg
import json
import os
import zipfile
import zlib
from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._errors import WriteError, fault
from ._quantities import PathLike

__all__ = ["Kept", "load_values", "save_values"]

ARRAY = "array of the file"
"""The key of what stands for an array or bytes in a file."""


class Kept:
    """What an object of the library would answer, by its attributes and calls."""

    def __init__(self, values: dict[str, Any]) -> None:
        self._values = values
        _protect(values)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "_values":
            raise AttributeError(name)
        return self._values[name] if name in self._values else partial(self._answer, name)

    def _answer(self, name: str, *arguments: Any) -> Any:
        call = f"{name}{arguments}"
        if call in self._values:
            return self._values[call]
        if name == "write":
            return self._write(*arguments)
        raise fault(name, "is not possible of a solution that was loaded or pickled", "ask it where it was computed, or solve it again")

    def _write(self, folder: str | None) -> list[str]:
        target = Path(folder or Path("output") / "results")
        written = []
        for name, content in self._values["files"].items():
            path = target / name
            if path.exists():
                raise WriteError(f"{path} exists already: name an empty folder")
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(bytes(content))
            except OSError as cause:
                raise WriteError(f"{path} cannot be written: {cause}") from cause
            written.append(os.fspath(path))
        return written

    def __reduce__(self) -> tuple[Any, ...]:
        return Kept, (self._values,)


def _protect(value: Any) -> None:
    """Arrays are read-only, as those of the library are."""
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    elif isinstance(value, dict):
        _protect(list(value.values()))
    elif isinstance(value, (list, tuple)):
        for one in value:
            _protect(one)


def _answers(core: Any, attributes: Iterable[str], calls: Iterable[tuple[str, tuple[int, ...]]]) -> dict[str, Any]:
    found = {name: getattr(core, name) for name in attributes}
    found.update((f"{name}{arguments}", getattr(core, name)(*arguments)) for name, arguments in calls)
    return found


def values_of(core: Any) -> dict[str, Any]:
    """All that a solution or results answer."""
    if isinstance(core, Kept):
        return core._values
    return _of_results(core) if isinstance(core, _core.Results) else _of_solution(core)


def _of_results(core: _core.Results) -> dict[str, Any]:
    calls: list[tuple[str, tuple[int, ...]]] = [(name, ()) for name in ("json", "markdown", "pictures", "tables", "fields")]
    for series, (_, times) in enumerate(core.fields()):
        places = [(series, number) for number in range(len(times))]
        calls += [(name, place) for place in places for name in ("field_points", "field_cells", "field_arrays")]
    found = _answers(core, ("passed", "title", "kind", "seconds", "summary", "warnings", "doubts"), calls)
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        written = [Path(path) for path in core.write(os.fspath(Path(folder) / "results"))]
        root = Path(folder) / "results"
        found["files"] = {os.fspath(path.relative_to(root)): path.read_bytes() for path in written}
    for number, (name, _) in enumerate(core.pictures()):
        found[f"picture{(number,)}"] = found["files"].get(name) or core.picture(number)
    return found


def _of_solution(core: _core.Solution) -> dict[str, Any]:
    of_step = ("balance", "energy", "residuals", "displacement", "residual", "at_groups", "multipliers", "arrays")
    calls: list[tuple[str, tuple[int, ...]]] = [(name, ()) for name in ("cells", "group_nodes", "factors", "forces")]
    calls += [(name, (step,)) for step in range(len(core.factors())) for name in of_step]
    return {**_answers(core, ("points", "thickness", "seconds", "warnings"), calls), "ends": []}


def save_values(path: PathLike, values: dict[str, Any]) -> None:
    """Writes values with arrays into a compressed file of NumPy."""
    arrays: list[Any] = []

    def plain(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: plain(one) for key, one in value.items()}
        if isinstance(value, (list, tuple)):
            return [plain(one) for one in value]
        if isinstance(value, (bytes, np.ndarray)):
            arrays.append(np.frombuffer(value, dtype=np.uint8) if isinstance(value, bytes) else value)
            return {ARRAY: len(arrays) - 1}
        return value

    text = json.dumps(plain(values)).encode()
    try:
        with open(path, "wb") as file:
            np.savez_compressed(file, *arrays, text=np.frombuffer(text, dtype=np.uint8))
    except OSError as cause:
        raise WriteError(f"{path} cannot be written: {cause}") from cause


def load_values(path: PathLike) -> dict[str, Any]:
    """Reads what `save_values` has written; nothing in the file is executed."""
    try:
        with np.load(path, allow_pickle=False) as file:
            found: dict[str, Any] = _with_arrays(json.loads(file["text"].tobytes()), file)
            return found
    except (OSError, EOFError, ValueError, LookupError, TypeError, AttributeError, zipfile.BadZipFile, zlib.error) as cause:
        raise fault("path", f"{path} cannot be read: {cause}", "name a file that save has written") from None


def _with_arrays(value: Any, file: Any) -> Any:
    if isinstance(value, dict) and list(value) == [ARRAY]:
        array = file[f"arr_{value[ARRAY]}"]
        return array.tobytes() if array.dtype == np.uint8 else array
    if isinstance(value, dict):
        return {key: _with_arrays(one, file) for key, one in value.items()}
    return [_with_arrays(one, file) for one in value] if isinstance(value, list) else value


def _reduce(core: Any) -> tuple[Any, ...]:
    return Kept, (values_of(core),)


for _kind in (_core.Results, _core.Solution):
    copyreg.pickle(_kind, _reduce)
