"""Progress callbacks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

__all__ = ["Progress", "callback"]

Progress: TypeAlias = "Callable[[str], object] | Any"
"""A callable that is told what is being done, or a bar of tqdm."""


def callback(progress: Progress | None) -> Callable[[str], object] | None:
    """What the computation calls: the callable itself, or one that moves a bar of tqdm."""
    if progress is None or not hasattr(progress, "set_postfix_str"):
        return progress
    bar: Any = progress

    def tell(what: str) -> None:
        bar.set_postfix_str(what, refresh=False)
        bar.update()

    return tell
