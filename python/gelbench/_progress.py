"""Progress callbacks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

__all__ = ["Progress", "callback"]

Progress: TypeAlias = "Callable[[str], object] | Any"
"""A callable that receives progress messages, or a tqdm bar."""


def callback(progress: Progress | None) -> Callable[[str], object] | None:
    """The callable for the computation: the one given, or one that advances a tqdm bar."""
    if progress is None or not hasattr(progress, "set_postfix_str"):
        return progress
    bar: Any = progress

    def tell(what: str) -> None:
        bar.set_postfix_str(what, refresh=False)
        bar.update()

    return tell
