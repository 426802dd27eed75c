"""Exceptions and warnings, by who must act on them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

__all__ = ["Fault", "InputError", "SolveError", "WriteError"]


OPTION = re.compile(r"--([a-z][a-z-]*)(?:[ =]((?:\"[^\"]*\"|[^\s,;)`\"]|,(?=\S))+))?")
PROSE = ("and", "as", "for", "if", "in", "is", "of", "or", "to", "where", "with")
NAMES = {"poisson": "poisson_ratio", "young": "youngs_modulus", "study": "conditions"}
"""Arguments with other names than the options."""


def _argument(option: re.Match[str]) -> str:
    name, value = option[1].replace("-", "_"), option[2]
    name = NAMES.get(name, name)
    if value is None or value in PROSE:
        return f"{name}=" + (f" {value}" if value else "")
    if name == "parameter":
        return value
    if re.fullmatch(r'"[^"]*"|[-+.\de]+', value):
        return f"{name}={value}"
    return f"{name}='{value}'" if '"' in value else f'{name}="{value}"'


def in_python(text: str) -> str:
    """A message with arguments in place of the command's options; commands, which stand in backticks, are left as they are."""
    parts = text.split("`")
    parts[::2] = [OPTION.sub(_argument, part) for part in parts[::2]]
    return "`".join(parts)


class Fault(NamedTuple):
    """One fault of an input: its location, its description and a remedy."""

    message: str
    """What is wrong."""
    key: str = ""
    """The key or argument, such as ``plate.length``; empty if there is none."""
    hint: str | None = None
    """What to do about it."""
    file: str | None = None
    """The file, if there is one."""
    line: int | None = None
    """The line of the file, from 1."""
    is_warning: bool = False
    """Whether the computation could continue in spite of it."""
    text: str = ""
    """The whole fault in one line."""

    def __str__(self) -> str:
        return self.text or self.message


class InputError(ValueError):
    """The input is wrong.

    Attributes
    ----------
    faults : tuple of Fault
        All faults at once.
    """

    faults: tuple[Fault, ...]

    def __init__(self, message: str, faults: Sequence[Fault] = ()) -> None:
        super().__init__(in_python(message))
        translated = (
            one._replace(message=in_python(one.message), hint=one.hint and in_python(one.hint), text=in_python(one.text)) for one in faults
        )
        self.faults = tuple(translated) or (Fault(str(self), text=str(self)),)


class SolveError(RuntimeError):
    """No solution of a model was found.

    Attributes
    ----------
    model : str
        The model, such as ``finite elements``.
    step : str
        Position on the load path, such as ``load factor 0.75 (reached 0.6183)``.
    load_factor : float or None
        The first requested load factor, or stretch of a plate, that was not reached.
    cell : str or None
        The cell or node where it happened, with its position.
    cause : str
        What happened.
    advice : str
        What to try.
    solution : gelbench.Solution or None
        The part reached before.
    """

    def __init__(
        self,
        message: str,
        *,
        model: str = "",
        step: str = "",
        cause: str = "",
        cell: str | None = None,
        advice: str = "",
    ) -> None:
        super().__init__(message)
        self.model = model
        self.step = step
        self.cause = cause
        self.cell = cell
        self.advice = advice
        self.load_factor: float | None = None
        self.solution: Any = None

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self.args, self.__dict__


class WriteError(OSError):
    """A file could not be written."""


def fault(argument: str, message: str, hint: str) -> InputError:
    """One fault of an argument."""
    text = f"{argument}: {message} ({hint})"
    return InputError(text, [Fault(message, argument, hint, text=text)])
