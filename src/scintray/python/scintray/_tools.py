"""What the modules of the package share: estimates, optional packages, tables for notebooks."""

from __future__ import annotations

import html
import importlib
import math
from typing import Any, Iterable, List, NamedTuple, Optional, Sequence

import numpy as np

from .errors import InputError, MissingPackage


class Estimate(NamedTuple):
    """A value with its one-sigma standard error."""

    value: float
    error: float

    def __str__(self) -> str:
        if not (math.isfinite(self.error) and self.error > 0.0):
            return f"{self.value:.6g}"
        digits = max(0, 1 - math.floor(math.log10(self.error)))
        if digits > 9 or abs(self.value) >= 1e9:
            return f"{self.value:.6g} ± {self.error:.2g}"
        return f"{self.value:.{digits}f} ± {self.error:.{digits}f}"

    def __float__(self) -> float:
        return float(self.value)

    def sigmas_from(self, other: "Estimate") -> float:
        """Distance to another estimate in units of the combined standard error."""
        error = math.hypot(self.error, other.error)
        return abs(self.value - other.value) / error if error > 0.0 else math.inf


def estimate(pair: Any) -> Estimate:
    return Estimate(float(pair[0]), float(pair[1]))


def need(package: str, what: str) -> Any:
    """An optional package. Raises MissingPackage with the name of Debian's package."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        name = package.split(".")[0]
        raise MissingPackage(f"{what} needs {name}, which is not installed; "
                             f"hint: apt-get install python3-{name}, or pip install {name}") from error


def axes_for(ax: Optional[Any], **subplots: Any) -> Any:
    """The given axes of matplotlib, or new ones."""
    if ax is not None:
        return ax
    _, ax = need("matplotlib.pyplot", "plot()").subplots(constrained_layout=True, **subplots)
    return ax


def html_table(title: str, heads: Sequence[str], rows: Iterable[Sequence[Any]], note: str = "") -> str:
    """A table for notebooks."""
    def cells(tag: str, values: Sequence[Any]) -> str:
        return "<tr>" + "".join(f"<{tag} style='text-align:left'>{html.escape(str(v))}</{tag}>" for v in values) + "</tr>"
    body = "".join(cells("td", row) for row in rows)
    note = f"<p>{html.escape(note)}</p>" if note else ""
    return f"<div><b>{html.escape(title)}</b><table>{cells('th', heads)}{body}</table>{note}</div>"


def numbers(values: Any, name: str, shape: Sequence[int], unit: str = "") -> np.ndarray:
    """Finite numbers as a contiguous array of doubles. -1 in ``shape`` stands for any length.

    Raises InputError with the name, the shape found and the one expected, and the first value that is not
    finite.
    """
    expected = "(" + ", ".join("n" if n < 0 else str(n) for n in shape) + ("," if len(shape) == 1 else "") + ")"
    try:
        array = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} is not an array of numbers: {error}",
                         f"give an array of shape {expected}" + (f" in {unit}" if unit else "")) from error
    if array.ndim != len(shape) or any(n >= 0 and n != m for n, m in zip(shape, array.shape)):
        raise InputError(f"{name} has the shape {array.shape}; expected {expected}",
                         f"give an array of shape {expected}" + (f" in {unit}" if unit else ""))
    wrong = np.argwhere(~np.isfinite(array))
    if len(wrong):
        where = ", ".join(str(i) for i in wrong[0])
        raise InputError(f"{name}[{where}] is {array[tuple(wrong[0])]}, which is not finite"
                         + (f" ({len(wrong)} such values)" if len(wrong) > 1 else ""),
                         "remove or replace values that are not numbers")
    return array


def positive_integer(value: Any, name: str) -> Optional[int]:
    """None, or a whole number above 0."""
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 1:
        raise InputError(f"{name} is {value!r}; expected a whole number from 1 on", f"write {name}=1, for example")
    return int(value)


def dataframe(columns: Any, units: Any) -> Any:
    """A DataFrame whose ``attrs["units"]`` has the unit of each column."""
    frame = need("pandas", "a DataFrame").DataFrame(columns)
    frame.attrs["units"] = {name: unit for name, unit in units.items() if name in frame.columns}
    return frame


def names_hint(kind: str, wanted: Any, names: Sequence[str]) -> InputError:
    """The error of a name that does not exist, with those that do."""
    import difflib
    near = difflib.get_close_matches(str(wanted), list(names), 1)
    shown: List[str] = list(names)[:8]
    hint = (f'did you mean "{near[0]}"? ' if near else "") + "there are: " + ", ".join(shown) \
        + (", ..." if len(names) > len(shown) else "") if names else "there are none"
    return InputError(f'no {kind} is called "{wanted}"', hint)
