"""Solutions and results that were saved."""

from __future__ import annotations

from typing import Any

from ._errors import fault
from ._images import Tracked
from ._kept import Kept, load_values
from ._markers import Correction
from ._quantities import PathLike
from ._results import Results
from ._solution import Solution

__all__ = ["load"]


def load(path: PathLike) -> Any:
    """Reads what `Solution.save`, `Results.save` and those of corrections and tracked images have written; nothing in the file is executed.

    Raises
    ------
    gelbench.InputError
        If the file cannot be read.
    """
    found = load_values(path)
    if not isinstance(found, dict) or not found.keys() >= {"type", "values"}:
        raise fault("path", f"{path} holds no results of gelbench", "name a file that save has written")
    core: Any = Kept(found["values"])
    kind = found["type"]
    if kind == "Solution":
        return Solution(core, found["model"], {factor: errors for factor, errors in found["errors"]})
    return Correction(core, found["verdict"]) if kind == "Correction" else {"Tracked": Tracked}.get(kind, Results)(core)
