"""Analyses of events: spectrum, photopeak, light against depth, flood map, timing."""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from ._tools import Estimate, Shown, axes_for, dataframe, estimate, html_table
from .errors import InputError

__all__ = ["Analysis", "DepthCurve", "DepthOfInteraction", "FloodMap", "Histogram", "Peak", "Timing"]


class Histogram(Shown):
    """Counts (bins) between ``edges`` (bins + 1); counts ``below`` and ``above`` them."""

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.edges: np.ndarray = entry["edges"]
        self.counts: np.ndarray = entry["counts"]
        self.below: float = entry["below"]
        self.above: float = entry["above"]

    def plot(self, ax: Optional[Any] = None, label: str = "") -> Any:
        """Draws the counts as steps. Returns the axes."""
        ax = axes_for(ax)
        ax.stairs(self.counts, self.edges)
        ax.set_xlabel(label)
        ax.set_ylabel("events per bin")
        return ax

    def _rows(self) -> Any:
        return [("bins", len(self.counts)), ("from", f"{self.edges[0]:g}"), ("to", f"{self.edges[-1]:g}"),
                ("counts", f"{self.counts.sum():g}"), ("below", f"{self.below:g}"), ("above", f"{self.above:g}")]

    def __repr__(self) -> str:
        return (f"Histogram({len(self.counts)} bins from {self.edges[0]:g} to {self.edges[-1]:g}, "
                f"{self.counts.sum():g} counts)")


class Peak(Shown):
    """A fitted Gaussian peak: ``position``, ``sigma``, ``events`` and ``relative_fwhm`` with their errors where
    it ``converged``, nan where not; ``p_value`` of the fit; ``histogram`` of the bins fitted and ``expected`` counts in them.

    Of a photopeak also ``status`` ("trusted", "poor fit", ...) and its ``reason``.
    """

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.converged: bool = entry["converged"]
        def fitted(name: str) -> Estimate:
            return estimate(entry[name]) if entry["converged"] else Estimate(np.nan, np.nan)
        self.position, self.sigma = fitted("position"), fitted("sigma")
        self.events, self.relative_fwhm = fitted("events"), fitted("relative_fwhm")
        self.p_value: float = entry["p_value"]
        self.histogram = Histogram(entry["histogram"])
        self.expected: np.ndarray = entry["expected"]
        self.status: str = entry.get("status", "")
        self.reason: str = entry.get("reason", "")

    def _draw(self, ax: Any) -> None:
        if self.converged and len(self.expected):
            ax.stairs(self.expected, self.histogram.edges, color="C1", linewidth=1.5, baseline=None)

    def plot(self, ax: Optional[Any] = None, label: str = "") -> Any:
        """Draws the fitted bins, and the fit. Returns the axes."""
        ax = self.histogram.plot(ax, label)
        self._draw(ax)
        return ax

    def _rows(self) -> Any:
        state = [("status", self.status), ("reason", self.reason)] if self.status else []
        if not self.converged:
            return state or [("fit", "not converged")]
        return [("position", self.position), ("sigma", self.sigma), ("resolution (FWHM)", self.relative_fwhm),
                ("events", self.events), ("p-value of the fit", f"{self.p_value:.3g}")] + state

    def __repr__(self) -> str:
        if not self.converged:
            return f"Peak({self.status or 'not converged'})"
        return f"Peak(at {self.position}, resolution {self.relative_fwhm} FWHM, {self.status})".replace(", )", ")")


class Timing(Peak):
    """Differences of times, ns: ``fwhm_ns``, the width to quote, ``gaussian_fwhm`` of a fitted Gaussian,
    ``quantile_fwhm`` between quantiles, and ``mean``, each with its error; ``count`` of differences."""

    def __init__(self, entry: Dict[str, Any], quoted: Optional[Any] = None) -> None:
        super().__init__(entry)
        self.count: int = entry["count"]
        self.mean: Estimate = estimate(entry["mean"])
        self.gaussian_fwhm: Estimate = estimate(entry["gaussian_fwhm"])
        self.quantile_fwhm: Estimate = estimate(entry["quantile_fwhm"])
        self.fwhm_ns: Estimate = estimate(quoted) if quoted is not None else self.quantile_fwhm

    def plot(self, ax: Optional[Any] = None, label: str = "difference of times (ns)") -> Any:
        """Draws the differences, and the fit. Returns the axes."""
        ax = super().plot(ax, label)
        ax.set_title(f"{1e3 * self.fwhm_ns.value:.0f} ± {1e3 * self.fwhm_ns.error:.0f} ps FWHM")
        return ax

    def _rows(self) -> Any:
        return [("FWHM (ns)", self.fwhm_ns), ("of a Gaussian (ns)", self.gaussian_fwhm),
                ("between quantiles (ns)", self.quantile_fwhm), ("mean (ns)", self.mean), ("differences", self.count)]

    def __repr__(self) -> str:
        return f"Timing({self.fwhm_ns} ns FWHM from {self.count} differences)"


class DepthCurve(Shown):
    """Light against depth: ``depth_mm`` (n,), ``count`` (n,) of events, ``value`` (n, 2: with errors),
    ``relative`` (n, 2) to the reference point, ``from_peak`` (photopeak positions, else means),
    ``slope_per_mm`` (relative change per mm)."""

    def __init__(self, entry: Dict[str, Any], unit: str) -> None:
        self.depth_mm: np.ndarray = entry["depth_mm"]
        self.count: np.ndarray = entry["count"]
        self.value: np.ndarray = entry["value"]
        self.relative: np.ndarray = entry["relative"]
        self.from_peak: bool = entry["from_peak"]
        self.slope_per_mm: Estimate = estimate(entry["relative_slope_per_mm"])
        self._line = (estimate(entry["line"]["offset"]), estimate(entry["line"]["slope"]))
        self._unit = unit

    def to_dataframe(self) -> Any:
        """A DataFrame with units in ``attrs["units"]``. Raises MissingPackage without pandas."""
        return dataframe({"depth_mm": self.depth_mm, "events": self.count, "light": self.value[:, 0],
                          "light_error": self.value[:, 1]},
                         {"depth_mm": "mm", "light": self._unit, "light_error": self._unit, "events": "1"})

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws the light against depth with the fitted straight line. Returns the axes."""
        ax = axes_for(ax)
        ax.errorbar(self.depth_mm, self.value[:, 0], self.value[:, 1], fmt="o", markersize=4, capsize=2)
        x = np.array([self.depth_mm.min(), self.depth_mm.max()])
        ax.plot(x, self._line[0].value + self._line[1].value * x, color="C1")
        ax.set_xlabel("depth (mm)")
        ax.set_ylabel(f"{'photopeak' if self.from_peak else 'mean light'} ({self._unit})")
        return ax

    def _rows(self) -> Any:
        rows = [(f"light at {z:.4g} mm ({self._unit})", estimate(light)) for z, light in zip(self.depth_mm, self.value)]
        return rows + [("relative slope (1/mm)", self.slope_per_mm)]

    def __repr__(self) -> str:
        return f"DepthCurve({len(self.depth_mm)} depths, {self.slope_per_mm} of the light per mm)"


class DepthOfInteraction(Shown):
    """Depth of interaction from the light at two ends: ``residual`` (estimated minus true, mm), and against
    ``depth_mm`` (n,) the ``bias_mm`` and ``fwhm_mm`` (n, 2: with errors); ``calibration``: ratios and depths
    (mm)."""

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.residual = Timing(entry["residual"])
        self.depth_mm: np.ndarray = entry["depth_mm"]
        self.bias_mm: np.ndarray = entry["bias_mm"]
        self.fwhm_mm: np.ndarray = entry["fwhm_mm"]
        self.calibration: Tuple[np.ndarray, np.ndarray] = (entry["calibration_ratio"], entry["calibration_depth_mm"])

    @property
    def fwhm(self) -> Estimate:
        """Resolution over all depths, mm FWHM."""
        return self.residual.quantile_fwhm

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws resolution and bias against depth. Returns the axes."""
        ax = axes_for(ax)
        ax.errorbar(self.depth_mm, self.fwhm_mm[:, 0], self.fwhm_mm[:, 1], fmt="o-", label="FWHM", capsize=2)
        ax.errorbar(self.depth_mm, self.bias_mm[:, 0], self.bias_mm[:, 1], fmt="s-", label="bias", capsize=2)
        ax.set_xlabel("depth (mm)")
        ax.set_ylabel("estimated depth (mm)")
        ax.legend()
        return ax

    def _rows(self) -> Any:
        rows = [(f"FWHM at {z:.4g} mm (mm)", estimate(width)) for z, width in zip(self.depth_mm, self.fwhm_mm)]
        return rows + [("FWHM over all depths (mm)", self.fwhm)]

    def __repr__(self) -> str:
        return f"DepthOfInteraction({self.fwhm} mm FWHM)"


class FloodMap(Shown):
    """Event positions by Anger logic: ``counts`` (rows, columns; the first row lowest) over ``extent_mm``
    (x low, x high, y low, y high), ``peak_of_cell``, ``peak_mm`` (n, 2), ``peak_events``, ``peak_part`` (names),
    ``share_right`` (events whose peak belongs to the part of the interaction), ``peak_to_valley``."""

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.counts: np.ndarray = entry["counts"]
        self.peak_of_cell: np.ndarray = entry["peak_of_cell"]
        self.extent_mm: Tuple[float, float, float, float] = entry["extent_mm"]
        self.peak_mm: np.ndarray = entry["peak_mm"]
        self.peak_events: np.ndarray = entry["peak_events"]
        self.peak_part: List[str] = entry["peak_part"]
        self.parts: List[str] = entry["parts"]
        self.share_right: Estimate = estimate(entry["share_right"])
        self.peak_to_valley: float = entry["peak_to_valley"]
        self.worst_peak_to_valley: float = entry["worst_peak_to_valley"]

    def plot(self, ax: Optional[Any] = None, *, peaks: bool = True) -> Any:
        """Draws the map on a square-root colour scale up to the 99 % quantile of the cells with events, so that
        valleys and faint peaks are visible, with a ring about each peak. Returns the axes."""
        ax = axes_for(ax)
        from matplotlib.colors import PowerNorm
        filled = self.counts[self.counts > 0]
        top = max(1.0, float(np.quantile(filled, 0.99))) if len(filled) else 1.0
        image = ax.imshow(self.counts, origin="lower", extent=self.extent_mm, cmap="inferno",
                              norm=PowerNorm(0.5, vmin=0, vmax=top), interpolation="nearest")
        if peaks and len(self.peak_mm):
            ax.plot(self.peak_mm[:, 0], self.peak_mm[:, 1], "o", color="cyan", markersize=9, markerfacecolor="none",
                        markeredgewidth=0.6)
        ax.set_xlabel("x (mm)")
        ax.set_ylabel("y (mm)")
        ax.set_title(f"{len(self.peak_mm)} peaks, {100 * self.share_right.value:.1f} % of events in the right one")
        ax.figure.colorbar(image, ax=ax, label="events per cell", shrink=0.8, extend="max")
        return ax

    def _rows(self) -> Any:
        return [("peaks", len(self.peak_mm)), ("crystals", len(self.parts)), ("events in the right peak", self.share_right),
                ("peak to valley", f"{self.peak_to_valley:.4g}"),
                ("peak to valley, the worst", f"{self.worst_peak_to_valley:.4g}")]

    def __repr__(self) -> str:
        return f"FloodMap({len(self.peak_mm)} peaks, {self.share_right} right, peak to valley {self.peak_to_valley:.3g})"


class Analysis:
    """All analyses of the events of a point; an analysis that the events do not permit is None, and
    ``left_out`` has the reason.

    ``events``, ``pulses`` (events with light), ``selected`` (in flood map, depth and timing; ``selection``
    describes them), ``light_unit`` ("photons" or "photoelectrons"), ``spectrum``, ``photopeak``,
    ``mean_light``, ``light_per_keV``, ``light_against_depth``, ``doi``, ``flood``, ``ctr`` (coincidence timing
    resolution of two such detectors), ``ctr_first_photon``, ``end_difference``, and the arrays of
    ``timing_against_depth`` and ``ctr_by_order`` in dictionaries.
    """

    events: int
    pulses: int
    selected: int
    selection: str
    light_unit: str
    left_out: List[str]
    timing_against_depth: Optional[Dict[str, Any]]
    ctr_by_order: Optional[Dict[str, Any]]
    ctr_by_average: Optional[Dict[str, Any]]

    def __init__(self, entry: Dict[str, Any]) -> None:
        for name in ("events", "pulses", "selected", "selection", "light_unit", "left_out", "timing_against_depth",
                     "ctr_by_order", "ctr_by_average"):
            setattr(self, name, entry[name])
        self.mean_light: Estimate = estimate(entry["mean_light"])
        self.light_per_keV: Estimate = estimate(entry["light_per_keV"])
        self.photopeak = Peak(entry["photopeak"])

        def made(kind: Any, name: str, *more: Any) -> Any:
            return None if entry[name] is None else kind(entry[name], *more)
        self.spectrum: Optional[Histogram] = made(Histogram, "spectrum")
        self.light_against_depth: Optional[DepthCurve] = made(DepthCurve, "light_against_depth", entry["light_unit"])
        self.doi: Optional[DepthOfInteraction] = made(DepthOfInteraction, "doi")
        self.flood: Optional[FloodMap] = made(FloodMap, "flood")
        self.ctr: Optional[Timing] = made(Timing, "ctr", entry["ctr_quoted"])
        self.ctr_first_photon: Optional[Timing] = made(Timing, "ctr_first_photon")
        self.end_difference: Optional[Timing] = made(Timing, "end_difference")

    def plot_spectrum(self, ax: Optional[Any] = None) -> Any:
        """Draws the spectrum of the light with the fit of its photopeak. Returns the axes; raises InputError
        without one."""
        if self.spectrum is None:
            raise InputError("there is no spectrum: the events have no two different numbers of photons",
                             "run more events")
        ax = self.spectrum.plot(ax, f"light ({self.light_unit})")
        peak = self.photopeak
        if peak.converged and len(peak.expected):
            ratio = np.diff(self.spectrum.edges)[0] / np.diff(peak.histogram.edges)[0]
            ax.stairs(peak.expected * ratio, peak.histogram.edges, color="C1", linewidth=1.5, baseline=None)
            self._cut(ax, ratio * float(peak.expected.max()))
            ax.set_title(f"resolution {100 * peak.relative_fwhm.value:.1f} ± "
                         f"{100 * peak.relative_fwhm.error:.1f} % FWHM ({peak.status})")
        return ax

    def _cut(self, ax: Any, peak: float) -> None:
        """Where a bin is far above the photopeak (events with dark counts only), ends the axis above the peak,
        and prints the number of that bin."""
        assert self.spectrum is not None
        highest = int(np.argmax(self.spectrum.counts))
        if self.spectrum.counts[highest] > 2.0 * peak:
            ax.set_ylim(0.0, 1.4 * peak)
            ax.annotate(f"{self.spectrum.counts[highest]:.0f} events", (self.spectrum.edges[highest + 1], 1.33 * peak),
                        xytext=(4, 0), textcoords="offset points", fontsize="small", va="center")

    def plot_timing_against_depth(self, ax: Optional[Any] = None) -> Any:
        """Draws the coincidence timing resolution and the mean time of events against their depth. Returns the
        axes; raises InputError without these."""
        if self.timing_against_depth is None:
            raise InputError("there is no timing against depth: " + ("; ".join(self.left_out) or "no slices"),
                             "give [analysis] a depth with slices, and run more events")
        ax, of = axes_for(ax), self.timing_against_depth
        ax.errorbar(of["depth_mm"], *(1e3 * of["ctr_fwhm_ns"]).T, fmt="o-", markersize=4, capsize=2, label="CTR (FWHM)")
        ax.errorbar(of["depth_mm"], *(1e3 * of["mean_ns"]).T, fmt="s-", markersize=4, capsize=2, label="mean time")
        ax.set_xlabel("depth (mm)")
        ax.set_ylabel("time (ps)")
        ax.legend()
        return ax

    def plot_ctr_by_order(self, ax: Optional[Any] = None) -> Any:
        """Draws the coincidence timing resolution by the n-th photon, and by the mean of the first n, against
        n. Returns the axes; raises InputError without times of n-th photons."""
        if self.ctr_by_order is None:
            raise InputError("there are no times of n-th photons", 'set scene["readout.photon_order"] = [1, 2, 3, 5, 10]')
        ax = axes_for(ax)
        for of, label in ((self.ctr_by_order, "n-th photon"), (self.ctr_by_average, "mean of the first n")):
            if of is not None and len(of["n"]):
                ax.errorbar(of["n"], *(1e3 * of["ctr_fwhm_ns"]).T, fmt="o-", markersize=4, capsize=2, label=label)
        ax.set_xlabel("n")
        ax.set_ylabel("CTR (ps FWHM)")
        ax.legend()
        return ax

    def plot(self) -> Any:
        """A figure with all available analyses: spectrum, light against depth, depth of interaction, flood map,
        timing, also against depth, and by the n-th photon. Returns the figure of matplotlib; raises InputError
        when there is none."""
        from ._tools import need
        draw = [(name, plot) for name, plot in (
            ("spectrum", self.plot_spectrum if self.spectrum is not None else None),
            ("flood", self.flood and self.flood.plot),
            ("depth", self.light_against_depth and self.light_against_depth.plot),
            ("doi", self.doi and self.doi.plot), ("ctr", self.ctr and self.ctr.plot),
            ("timing", self.plot_timing_against_depth if self.timing_against_depth is not None else None),
            ("orders", self.plot_ctr_by_order if self.ctr_by_order is not None else None)) if plot]
        if not draw:
            raise InputError("there is nothing to draw: " + "; ".join(self.left_out), "run more events")
        rows = (len(draw) + 1) // 2
        figure, axes = need("matplotlib.pyplot", "plot()").subplots(
            rows, min(2, len(draw)), figsize=(10, 4.2 * rows), squeeze=False, constrained_layout=True)
        for ax, (_, plot) in zip(axes.flat, draw):
            plot(ax)
        for ax in list(axes.flat)[len(draw):]:
            ax.remove()
        return figure

    def _rows(self) -> List[Tuple[str, str]]:
        rows = [("events", str(self.events)), ("pulses", str(self.pulses)),
                (f"mean light ({self.light_unit})", str(self.mean_light)), ("light per keV", str(self.light_per_keV))]
        for name, value in (("photopeak", self.photopeak), ("light against depth", self.light_against_depth),
                            ("depth of interaction", self.doi), ("flood map", self.flood), ("CTR", self.ctr)):
            if value is not None:
                text = repr(value)
                rows.append((name, text[text.index("(") + 1:-1]))
        return rows

    def __repr__(self) -> str:
        return "Analysis(" + "; ".join(f"{name}: {value}" for name, value in self._rows()) + ")"

    def _repr_html_(self) -> str:
        return html_table("Analysis of events", ("", ""), self._rows(), "; ".join(self.left_out))
