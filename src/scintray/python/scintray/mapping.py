"""Response maps and events sampled from them, fits of scenes to measurements, and reweighting."""

from __future__ import annotations

import os
import tempfile
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._checks import (flag, index_of, names_hint, number, numbers, one_of, path_text, positive_integer, thread_count, text_of, whole,
                      whole_or_none)
from ._tools import Estimate, Shown, axes_for, dataframe, estimate, html_table
from .errors import Cancelled, InputError
from .results import Results
from .scene import Scene, as_scene
from .simulation import Progress, watched, with_source

__all__ = ["Fit", "FitParameter", "ResponseMap", "ReweightedLight", "fit", "reweight"]

PathLike = Union[str, "os.PathLike[str]"]


def _guarded(scene: Scene, work: Any) -> Any:
    text, file = scene.text, scene.file
    try:
        return work(text, file)
    except InputError as error:
        raise with_source(error, text, file) from None


class ResponseMap:
    """Detection probabilities of light from each cell of the parts that scintillate, traced once
    (docs/response_maps.md).

    ``channels`` (names), ``photons_per_cell`` (0: traced backward), ``photons_per_channel`` (0: traced
    forward), ``parts`` (names); ``grids`` are dictionaries by part with ``low_mm``, ``pitch_mm``, ``photons``
    (x, y, z: emitted in each cell; 0: empty) and ``detected`` (x, y, z, channel); traced backward also with
    ``probability`` and ``probability_error`` (x, y, z, channel).
    """

    def __init__(self, core: Any) -> None:
        self._core = core
        self._file: Optional[str] = None
        self.channels: List[str] = core.channels()
        self.photons_per_cell: int = core.photons_per_cell()
        self.photons_per_channel: int = core.photons_per_channel()
        self.grids: Dict[str, Dict[str, Any]] = {}
        for i in range(core.grids()):
            grid = core.grid(i)
            self.grids[grid["part"]] = grid
        self.parts = list(self.grids)

    @classmethod
    def build(cls, scene: Union[Scene, PathLike], *, pitch_mm: float = 1.0, photons_per_cell: int = 10_000,
              delays: int = 64, direction: str = "automatic", photons_per_channel: int = 200_000,
              threads: Optional[int] = None, seed: Optional[int] = None,
              progress: Progress = None) -> "ResponseMap":
        """Traces the map of a scene, in cells of at most ``pitch_mm``: ``direction`` "forward" from the cells,
        "backward" from the channels, which requires reciprocal surfaces, or "automatic": backward where
        surfaces are reciprocal. ``delays``: times of flight kept per cell and channel. Raises InputError;
        Cancelled.
        """
        pitch = number(pitch_mm, "pitch_mm", "mm", above=0.0)
        one_of(direction, "direction", ("automatic", "forward", "backward"))
        start = whole_or_none(seed, "seed")
        return cls(_guarded(as_scene(scene), lambda text, file: watched(progress, lambda call: _core.build_response(
            text, file, pitch, whole(photons_per_cell, "photons_per_cell", least=1, most=2**32 - 1),
            whole(delays, "delays", least=1, most=2**32 - 1), direction,
            whole(photons_per_channel, "photons_per_channel", least=1), thread_count(threads), start,
            call))))

    @classmethod
    def read(cls, path: PathLike) -> "ResponseMap":
        """The map of a file. Raises InputError."""
        made = cls(_core.read_response(path_text(path)))
        made._file = os.path.abspath(path_text(path))
        return made

    def write(self, path: PathLike) -> None:
        """Writes the map (HDF5). Raises SystemFailure."""
        self._core.write(path_text(path))

    def probability(self, part: str) -> np.ndarray:
        """Detection probability by cell and channel (x, y, z, channel); nan in empty cells. Raises InputError
        for an unknown part."""
        if part not in self.parts:
            raise names_hint("part of the map", part, self.parts)
        grid = self.grids[part]
        emitted = grid["photons"].astype(float)[..., np.newaxis]
        if "probability" in grid:
            return np.where(emitted > 0, grid["probability"], np.nan)
        return np.divide(grid["detected"], emitted, out=np.full(grid["detected"].shape, np.nan), where=emitted > 0)

    def run(self, scene: Union[Scene, PathLike], *, output: Optional[PathLike] = None, threads: Optional[int] = None,
            seed: Optional[int] = None, events: Optional[int] = None, progress: Progress = None) -> Results:
        """Samples events of a scene from the map, without tracing; ``output`` is a results file to write. The
        scene must be that of the map, apart from source, run settings, readout and analysis.

        Raises InputError; Cancelled on Ctrl-C, with the partial results.
        """
        with tempfile.TemporaryDirectory(prefix="scintray-") as folder:
            if self._file is None:
                self.write(os.path.join(folder, "map.h5"))
            source = self._file if self._file is not None else os.path.join(folder, "map.h5")
            target = os.path.join(folder, "results.h5") if output is None else path_text(output, "output")
            data, raised = _guarded(as_scene(scene), lambda text, file: watched(progress, lambda call: _core.run_mapped(
                text, file, source, thread_count(threads), whole_or_none(seed, "seed"), positive_integer(events, "events"),
                target, output is not None, call)))
        if isinstance(raised, KeyboardInterrupt):
            raise Cancelled("stopped by Ctrl-C", Results(data)) from raised
        if raised is not None:
            raise raised
        return Results(data)

    def plot(self, ax: Optional[Any] = None, *, part: Optional[str] = None, channel: Optional[int] = None) -> Any:
        """Draws the detected share of a part over x and z, at the middle of y, for one channel or the sum of
        all. Returns the axes."""
        ax = axes_for(ax)
        part = part or self.parts[0]
        share = self.probability(part)
        if channel is not None:
            channel = index_of(channel, "channel", len(self.channels))
        share = share.sum(axis=-1) if channel is None else share[..., channel]
        low, pitch, cells = self.grids[part]["low_mm"], self.grids[part]["pitch_mm"], share.shape
        image = ax.imshow(share[:, cells[1] // 2, :].T, origin="lower", aspect="auto",
                          extent=(low[0], low[0] + cells[0] * pitch[0], low[2], low[2] + cells[2] * pitch[2]))
        ax.set_xlabel("x (mm)")
        ax.set_ylabel("z (mm)")
        ax.set_title(f"{part}: {'all channels' if channel is None else self.channels[channel]}")
        ax.figure.colorbar(image, ax=ax, label="detected share")
        return ax

    def __repr__(self) -> str:
        return f"ResponseMap({len(self.parts)} parts, {len(self.channels)} channels)"

    def _repr_html_(self) -> str:
        rows = [(name, " x ".join(map(str, grid["photons"].shape)), f"{np.nanmean(self.probability(name).sum(-1)):.4f}")
                for name, grid in list(self.grids.items())[:20]]
        return html_table("Response map", ("part", "cells", "mean detected share"), rows)


class FitParameter(Shown):
    """A fitted parameter: ``name``, ``value`` with its total error, ``unit``, ``monte_carlo_error`` (part of
    it), ``interval`` (one standard error of its ``variable``, "value" or "inverse", to both sides),
    ``in_variable`` (the value or its inverse, with that error), ``start``, ``low``, ``high``, ``at_bound``,
    ``determined``."""

    name: str
    unit: str
    monte_carlo_error: float
    interval: Tuple[float, float]
    variable: str
    start: float
    low: float
    high: float
    at_bound: bool
    determined: bool

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.__dict__.update(entry)
        self.value: Estimate = estimate(entry["value"])
        self.in_variable: Estimate = estimate(entry["in_variable"])

    def _rows(self) -> Any:
        return [(self.name, f"{self.value} {self.unit}".rstrip()), ("of it by Monte Carlo", f"{self.monte_carlo_error:.3g}"),
                ("interval", " to ".join(f"{end:.6g}" for end in self.interval)),
                ("bounds", f"{self.low:g} to {self.high:g}"), ("at a bound", self.at_bound),
                ("determined", self.determined)]

    def __repr__(self) -> str:
        return f"FitParameter({self.name} = {self.value} {self.unit})".replace(" )", ")")


class Fit:
    """A fit of a scene to a measurement: ``end`` ("converged", "not_converged", "stopped"), ``parameters`` (by
    name), ``correlation`` (p, p), ``scale``, ``x`` (n,), ``measured``, ``curve`` and ``start_curve`` (n, 2:
    with errors), ``residual`` (n,: over its error), ``chi2``, ``degrees``, ``p_value``, ``warnings``."""

    title: str
    end: str
    quantity: str
    position: str
    position_unit: str
    correlation: np.ndarray
    x: np.ndarray
    measured: np.ndarray
    curve: np.ndarray
    start_curve: np.ndarray
    residual: np.ndarray
    chi2: float
    degrees: float
    p_value: float
    warnings: List[str]
    steps: int

    def __init__(self, entry: Dict[str, Any]) -> None:
        self.__dict__.update(entry)
        self.scale: Estimate = estimate(entry["scale"])
        self.parameters: Dict[str, FitParameter] = {p["name"]: FitParameter(p) for p in entry["parameters"]}

    def to_dataframe(self) -> Any:
        """The curves as a DataFrame with units in ``attrs["units"]``."""
        columns = {self.position or "incidence": self.x, "measured": self.measured[:, 0],
                   "curve": self.scale.value * self.curve[:, 0], "residual": self.residual}
        return dataframe(columns, {self.position or "incidence": self.position_unit})

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws the measurement, the fitted curve, and the curve of the start. Returns the axes."""
        ax = axes_for(ax)
        ax.errorbar(self.x, *self.measured.T, fmt="o", markersize=4, capsize=2, label="measured")
        ax.errorbar(self.x, self.scale.value * self.curve[:, 0], self.scale.value * self.curve[:, 1], label="fit")
        ax.plot(self.x, self.start_curve[:, 0], ":", color="grey", label="start")
        ax.set_xlabel(f"{self.position or 'incidence'} ({self.position_unit})")
        ax.set_ylabel(self.quantity)
        ax.set_title(", ".join(f"{p.name} = {p.value} {p.unit}" for p in self.parameters.values()), fontsize="small")
        ax.legend()
        return ax

    def __repr__(self) -> str:
        return f"Fit({self.end}: " + ", ".join(repr(p)[13:-1] for p in self.parameters.values()) + ")"

    def _repr_html_(self) -> str:
        rows = [(p.name, str(p.value), p.unit) for p in self.parameters.values()]
        return html_table(f"Fit: {self.end}", ("parameter", "value", "unit"), rows,
                          f"chi-square {self.chi2:.4g} for {self.degrees:g} degrees of freedom, p = {self.p_value:.3g}")


def fit(scene: Union[Scene, PathLike], *, threads: Optional[int] = None, photons: Optional[int] = None,
        events: Optional[int] = None, progress: Progress = None, output: Optional[PathLike] = None) -> Fit:
    """Fits the [fit] of a scene to its measurement (docs/fit.md); ``output`` is a file (HDF5) to which the fit
    is written.

    Raises InputError for a scene without [fit], or with all mistakes of the scene; Cancelled.
    """
    return Fit(_guarded(as_scene(scene), lambda text, file: watched(progress, lambda call: _core.fit_scene(
        text, file, thread_count(threads), positive_integer(photons, "photons"),
        positive_integer(events, "events"), call, None if output is None else path_text(output, "output")))))


class ReweightedLight(List[Dict[str, Any]]):
    """Detected light for other values of a property: a list of dictionaries, as ``reweight`` describes them."""

    def __init__(self, entries: Sequence[Dict[str, Any]] = (), label: str = "value", unit: str = "1") -> None:
        super().__init__(entries)
        self.label = label
        self.unit = unit

    def to_dataframe(self) -> Any:
        """A DataFrame with one row per entry; units in ``attrs["units"]``."""
        columns: Dict[str, Any] = {name: [entry[name] for entry in self] for name in
                                   ("point", "value", "effective_photons", "valid", "reason")}
        for name in ("traced", "detected", "relative"):
            columns[name] = [entry[name].value for entry in self]
            columns[f"{name}_error"] = [entry[name].error for entry in self]
        return dataframe(columns, {name: self.unit if name == "value" else "1" for name in columns
                                   if name not in ("valid", "reason")})

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws the detected share against the values, a curve for each point; open circles mark values that
        are not valid (``valid`` is False). Returns the axes."""
        ax = axes_for(ax)
        for point in sorted({entry["point"] for entry in self}):
            rows = sorted((e for e in self if e["point"] == point), key=lambda e: float(e["value"]))
            bars = ax.errorbar([e["value"] for e in rows], [e["detected"].value for e in rows],
                               [e["detected"].error for e in rows], fmt="o-", markersize=4, capsize=2,
                               label=f"point {point}")
            out = [e for e in rows if not e["valid"]]
            ax.plot([e["value"] for e in out], [e["detected"].value for e in out], "o", markersize=9,
                    markerfacecolor="none", color=bars[0].get_color())
        ax.set_xlabel(self.label)
        ax.set_ylabel("detected share of the emitted photons")
        if len({entry["point"] for entry in self}) > 1:
            ax.legend()
        return ax

    def _repr_html_(self) -> str:
        rows = [(e["point"], f"{e['value']:g}", str(e["detected"]), str(e["relative"]), e["reason"]) for e in self]
        return html_table("Reweighted light", ("point", self.label, "detected", "relative to the traced", ""), rows)


def reweight(path: PathLike, name: str, values: Sequence[float], *, property: str = "absorption_length",
             factors: bool = False) -> ReweightedLight:
    """Detected light for other absorption lengths (mm) of a medium, or other reflectances of a reflector, from the
    histories of a results file (scene["run.photon_history"] = True), without tracing (docs/reweighting.md).

    With ``factors`` the values are factors on the traced ones. Returns a list, with ``plot()``, of dictionaries: ``point``, ``value``,
    ``traced`` and ``detected`` shares (``Estimate``), ``relative``, ``effective_photons``, ``valid``, ``reason``.
    Raises InputError without histories, for unknown names, and for values out of range.
    """
    one_of(property, "property", ("absorption_length", "reflectance"))
    wanted = numbers(np.atleast_1d(values), "values", (-1,))
    entries = _core.reweight(path_text(path), property, text_of(name, "name"), flag(factors, "factors"), wanted.tolist())
    for entry in entries:
        for key in ("traced", "detected", "relative"):
            entry[key] = estimate(entry[key])
    what = property.replace("_", " ") + f" of {name}"
    if factors:
        return ReweightedLight(entries, f"factor on the {what}")
    return ReweightedLight(entries, what) if property == "reflectance" else ReweightedLight(entries, f"{what} (mm)", "mm")
