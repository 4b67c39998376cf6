"""Exceptions. Those of the input have the place of the mistake, what was found and expected, and a hint."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, List, Optional, Sequence

__all__ = ["Cancelled", "ClosedError", "Error", "InputError", "InternalError", "MissingPackage", "Problem",
           "SystemFailure"]


@dataclass
class Problem:
    """One mistake of the input: its place, what is wrong, and how to correct it."""

    what: str
    """What was found and what was expected."""
    hint: str = ""
    """What to write or do; may be empty."""
    file: str = ""
    """The file, or the name of the scene that was made in Python."""
    line: int = 0
    """Line of the file or of ``Scene.text``, from 1; 0: unknown."""
    column: int = 0
    """Column, from 1; 0: unknown."""
    places_mm: Sequence[Sequence[float]] = field(default_factory=list)
    """Positions (x, y, z) in mm of a few examples."""
    source: str = ""
    """The line itself, where it is known."""

    def __str__(self) -> str:
        place = ":".join([self.file] + [str(n) for n in (self.line, self.column) if n]) if self.file else ""
        text = f"{place}: {self.what}" if place else self.what
        if self.source:
            text += f"\n    {self.source.strip()}"
        return text + (f"\n  hint: {self.hint}" if self.hint else "")


class Error(Exception):
    """Base of all exceptions of ScintRay."""


class InputError(Error, ValueError):
    """An error of the input, with all problems, not only the first."""

    def __init__(self, problems: Any, hint: str = "") -> None:
        if isinstance(problems, str):
            problems = [Problem(problems, hint)]
        self.problems: List[Problem] = list(problems)
        super().__init__(self.problems)

    def __str__(self) -> str:
        return "\n".join(str(problem) for problem in self.problems)


class SystemFailure(Error, OSError):
    """A failure of the operating system: a file cannot be written, a disk is full."""


class InternalError(Error, RuntimeError):
    """A defect in ScintRay itself: please report it."""


class ClosedError(Error, ValueError):
    """The object has been closed."""


class MissingPackage(Error, ImportError):
    """An optional package (matplotlib, pandas, xarray) is not installed."""


class Cancelled(Error, KeyboardInterrupt):
    """The work was stopped, usually by Ctrl-C; a KeyboardInterrupt, so that it ends a script."""

    def __init__(self, message: str = "stopped", results: Optional[Any] = None) -> None:
        super().__init__(message)
        self.results = results
        """The partial ``Results`` of a run, marked as not complete; None without any."""
