"""Tallies: sums over photons on grids of axes, with uncertainties."""

from __future__ import annotations

from typing import Any, Dict, List, Optional

import numpy as np

from ._tools import Estimate, Shown, axes_for, estimate, html_table, need

__all__ = ["Moments", "Tally", "TallyAxis"]


class Moments(Shown):
    """Mean and spread of a quantity over photons or events: ``count``, ``mean`` with its error,
    ``standard_deviation``."""

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.count: int = entry["count"]
        self.mean: Estimate = estimate(entry["mean"])
        self.standard_deviation: float = entry["standard_deviation"]

    def _rows(self) -> Any:
        return [("mean", self.mean), ("standard deviation", f"{self.standard_deviation:.6g}"), ("count", self.count)]

    def __repr__(self) -> str:
        return f"Moments(mean {self.mean}, standard deviation {self.standard_deviation:.6g}, count {self.count})"


class TallyAxis:
    """An axis of a tally: ``bins`` bins with ``edges`` (bins + 1) in ``unit``, or with ``names`` (bins)."""

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.variable: str = entry["variable"]
        self.unit: str = entry["unit"]
        self.names: List[str] = entry["names"]
        self.edges: np.ndarray = entry["edges"]
        self.bins = len(self.names) or len(self.edges) - 1

    @property
    def centres(self) -> np.ndarray:
        """Centres of the bins (bins,) in ``unit``; numbers from 0 for names."""
        return np.arange(self.bins) if self.names else 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def label(self) -> str:
        return f"{self.variable} ({self.unit})" if self.unit not in ("", "1") else self.variable

    def __repr__(self) -> str:
        return f"TallyAxis({self.label}, {self.bins} {'names' if self.names else 'bins'})"


class Tally:
    """Sums over the photons of a point on a grid of axes (docs/tallies.md).

    ``sum`` and ``error``, its one-sigma standard error, have one dimension per axis of ``axes``, and the
    ``unit`` of the score ("1": photons). ``outside`` is the score beyond the axes, ``photons`` the number
    traced.
    """

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.name: str = entry["name"]
        self.type: str = entry["type"]
        self.score: str = entry["score"]
        self.unit: str = entry["unit"]
        self.axes = [TallyAxis(axis) for axis in entry["axes"]]
        self.sum: np.ndarray = entry["sum"]
        self.error: np.ndarray = entry["error"]
        self.outside: float = entry["outside"]
        self.photons: int = entry["photons"]

    @property
    def per_photon(self) -> np.ndarray:
        """Score per emitted photon, of the shape of ``sum``."""
        return self.sum / max(self.photons, 1)

    @property
    def per_photon_error(self) -> np.ndarray:
        return self.error / max(self.photons, 1)

    def to_xarray(self) -> Any:
        """A Dataset with ``sum`` and ``error`` over the centres of the bins, with units as attributes. Raises
        MissingPackage without xarray."""
        xarray = need("xarray", "to_xarray()")
        names: List[str] = []
        for axis in self.axes:
            names.append(axis.variable if axis.variable not in names else f"{axis.variable}_{len(names)}")
        coordinates = {}
        for name, axis in zip(names, self.axes):
            coordinates[name] = (name, axis.names or axis.centres, {"units": axis.unit})
        data = {key: (names, values, {"units": self.unit}) for key, values in (("sum", self.sum), ("error", self.error))}
        return xarray.Dataset(data, coordinates, {"name": self.name, "type": self.type, "photons": self.photons})

    def plot(self, ax: Optional[Any] = None, *, log: bool = False) -> Any:
        """Draws one axis as steps with a band of one sigma, two as an image; further axes are summed over.
        Returns the axes."""
        ax = axes_for(ax)
        values, squares, axes = self.sum, self.error**2, self.axes
        while len(axes) > 2:
            values, squares, axes = values.sum(axis=-1), squares.sum(axis=-1), axes[:-1]
        score = f"{self.score} ({self.unit})" if self.unit not in ("", "1") else self.score
        if not axes:
            ax.errorbar([0], [float(values)], [float(np.sqrt(squares))], fmt="o")
            ax.set_ylabel(score)
        elif len(axes) == 1:
            axis, error = axes[0], np.sqrt(squares)
            if axis.names:
                ax.bar(axis.names, values, yerr=error)
                ax.tick_params(axis="x", rotation=45)
            else:
                ax.stairs(values, axis.edges)
                ax.stairs(values + error, axis.edges, baseline=values - error, fill=True, alpha=0.3)
            ax.set_xlabel(axis.label)
            ax.set_ylabel(score)
            if log:
                ax.set_yscale("log")
        else:
            edges = [np.arange(a.bins + 1) - 0.5 if a.names else a.edges for a in axes]
            mesh = ax.pcolormesh(edges[0], edges[1], values.T, norm="log" if log else None, rasterized=True)
            for axis, set_ticks in zip(axes, (ax.set_xticks, ax.set_yticks)):
                if axis.names and axis.bins <= 40:
                    set_ticks(range(axis.bins), axis.names, rotation=45)
            ax.set_xlabel(axes[0].label)
            ax.set_ylabel(axes[1].label)
            ax.figure.colorbar(mesh, ax=ax, label=score)
        ax.set_title(self.name or self.type)
        return ax

    def __repr__(self) -> str:
        axes = ", ".join(f"{a.variable}[{a.bins}]" for a in self.axes)
        return f"Tally({self.name!r}, {self.score} over {axes or 'nothing'}, total {float(self.sum.sum()):.6g})"

    def _repr_html_(self) -> str:
        rows = [(a.variable, a.bins, a.unit if not a.names else "names") for a in self.axes]
        return html_table(self.name or self.type, ("axis", "bins", "unit"), rows,
                          f"{self.score}, total {float(self.sum.sum()):.6g}")
