"""Tools shared by the modules of the package: estimates, optional packages, tables for notebooks."""

from __future__ import annotations

import html
import importlib
import math
from typing import Any, Iterable, NamedTuple, Optional, Sequence

from .errors import MissingPackage


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
        """Distance to another estimate in units of the combined standard error; inf where both errors are 0."""
        error = math.hypot(self.error, other.error)
        return abs(self.value - other.value) / error if error > 0.0 else math.inf


def estimate(pair: Any) -> Estimate:
    return Estimate(float(pair[0]), float(pair[1]))


def need(package: str, what: str) -> Any:
    """Imports an optional package. Raises MissingPackage with the name of Debian's package."""
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


class Shown:
    """Base of classes that notebooks show as a table of names and values, those of ``_rows()``."""

    def _rows(self) -> Iterable[Sequence[Any]]:
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return html_table(type(self).__name__, ("", ""), self._rows())


def html_table(title: str, heads: Sequence[str], rows: Iterable[Sequence[Any]], note: str = "") -> str:
    """A table for notebooks."""
    def cells(tag: str, values: Sequence[Any]) -> str:
        return "<tr>" + "".join(f"<{tag} style='text-align:left'>{html.escape(str(v))}</{tag}>" for v in values) + "</tr>"
    body = "".join(cells("td", row) for row in rows)
    note = f"<p>{html.escape(note)}</p>" if note else ""
    return f"<div><b>{html.escape(title)}</b><table>{cells('th', heads)}{body}</table>{note}</div>"


def dataframe(columns: Any, units: Any) -> Any:
    """A DataFrame whose ``attrs["units"]`` has the unit of each column."""
    frame = need("pandas", "a DataFrame").DataFrame(columns)
    frame.attrs["units"] = {name: unit for name, unit in units.items() if name in frame.columns}
    return frame
