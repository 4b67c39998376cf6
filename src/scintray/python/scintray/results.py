"""Results of runs: fates with uncertainties, tallies, events and photon lists as arrays."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional, Sequence, Union, overload

import numpy as np

from . import _core
from ._checks import names_hint, path_text, text_of
from ._tools import Estimate, Shown, axes_for, dataframe, estimate, html_table, need
from .errors import ClosedError, InputError
from .tallies import Moments, Tally

if TYPE_CHECKING:
    from .analysis import Analysis

__all__ = ["Events", "Point", "Results", "open_results"]


class Events(Shown):
    """The events of a point, in columns: read-only views of the library's memory.

    Per event: ``event`` (number), ``energy_keV`` (deposited in scintillators), ``escaped_keV``,
    ``non_scintillating_keV``, ``position_mm`` (n, 3: mean of the deposits weighted by energy), ``part`` (index into
    ``Results.parts`` of the largest deposit; -1: none), ``emitted`` and ``detected`` photons. Per event and channel
    (n, channels): ``channel_detected``, ``first_ns``, and with [readout] ``charge`` and ``amplitude``
    (photoelectrons) and ``time_ns``; nan: none. ``order_ns`` (n, channels, orders) has the times of the n-th photons
    of ``photon_order``, ``waveform`` (n, channels, samples) photoelectrons. ``channels`` is a dictionary: ``name``,
    ``part``, ``position_mm``, ``normal``, ``area_mm2``.
    """

    _PER_EVENT = ("event", "energy_keV", "escaped_keV", "non_scintillating_keV", "part", "emitted", "detected")
    _UNITS = {"energy_keV": "keV", "escaped_keV": "keV", "non_scintillating_keV": "keV", "x_mm": "mm", "y_mm": "mm",
              "z_mm": "mm", "event": "1", "emitted": "1", "detected": "1", "light": "photoelectrons"}

    event: np.ndarray
    energy_keV: np.ndarray
    escaped_keV: np.ndarray
    non_scintillating_keV: np.ndarray
    position_mm: np.ndarray
    part: np.ndarray
    emitted: np.ndarray
    detected: np.ndarray
    channel_detected: np.ndarray
    first_ns: np.ndarray
    charge: np.ndarray
    amplitude: np.ndarray
    time_ns: np.ndarray
    order_ns: np.ndarray
    waveform: np.ndarray
    photon_order: List[int]
    channels: Dict[str, Any]

    def __init__(self, entry: Dict[str, Any], parts: Sequence[str]) -> None:
        self.__dict__.update(entry)
        self._parts = list(parts)

    def __len__(self) -> int:
        return len(self.event)

    @property
    def has_readout(self) -> bool:
        """True when the scene has a [readout], so that charges are available."""
        return self.charge.size > 0 and not bool(np.isnan(self.charge).any())

    @property
    def light(self) -> np.ndarray:
        """Sum of the light of all channels, per event (n,): charge in photoelectrons, or detected photons
        without [readout]."""
        return (self.charge if self.has_readout else self.channel_detected).sum(axis=1)

    def to_dataframe(self) -> Any:
        """A DataFrame with one row per event; units in ``attrs["units"]``. Raises MissingPackage without
        pandas."""
        columns: Dict[str, Any] = {name: getattr(self, name) for name in self._PER_EVENT}
        columns["part"] = [self._parts[i] if i >= 0 else None for i in self.part]
        for k, axis in enumerate("xyz"):
            columns[f"{axis}_mm"] = self.position_mm[:, k]
        columns["light"] = self.light
        return dataframe(columns, {**self._UNITS, "light": "photoelectrons" if self.has_readout else "1"})

    def to_xarray(self) -> Any:
        """A Dataset over ``event`` and ``channel``, with units as attributes. Raises MissingPackage without
        xarray."""
        xarray = need("xarray", "to_xarray()")
        data: Dict[str, Any] = {}
        for name in self._PER_EVENT[1:]:
            data[name] = ("event", getattr(self, name), {"units": "keV" if name.endswith("keV") else "1"})
        data["position"] = (("event", "axis"), self.position_mm, {"units": "mm"})
        for name, unit in (("channel_detected", "1"), ("first_ns", "ns"), ("charge", "photoelectrons"),
                           ("amplitude", "photoelectrons"), ("time_ns", "ns")):
            data[name] = (("event", "channel"), getattr(self, name), {"units": unit})
        return xarray.Dataset(data, {"event": self.event, "channel": self.channels["name"], "axis": list("xyz")})

    def plot(self, ax: Optional[Any] = None, *, bins: Any = "auto") -> Any:
        """Draws the histogram of the light of the events. Returns the axes."""
        ax = axes_for(ax)
        counts, edges = np.histogram(self.light[self.light > 0], bins=bins)
        ax.stairs(counts, edges)
        ax.set_xlabel("light (photoelectrons)" if self.has_readout else "detected photons")
        ax.set_ylabel("events per bin")
        return ax

    def __repr__(self) -> str:
        return f"Events({len(self)} events, {len(self.channels['name'])} channels)"

    def _rows(self) -> Any:
        unit = "photoelectrons" if self.has_readout else "photons"
        rows: List[Any] = [("events", len(self)), ("channels", len(self.channels["name"]))]
        if len(self):
            rows += [("energy in scintillators, mean (keV)", f"{self.energy_keV.mean():.6g}"),
                     ("emitted photons, mean", f"{self.emitted.mean():.6g}"),
                     ("detected photons, mean", f"{self.detected.mean():.6g}"),
                     (f"light, mean ({unit})", f"{self.light.mean():.6g}")]
        return rows


class Point:
    """Results of one point of a sweep (a run without a sweep has one).

    ``photons`` emitted of ``photons_requested``; ``photons_traced``, those counted in ``fate_count`` (in the
    order of ``Results.fates``): all but those that no sensor would convert, where ``birth_efficiency`` is below
    1; ``interactions``, ``detected_path_mm``, ``detected_time_ns``, ``detected_interactions`` (``Moments``),
    ``detected_path_histogram`` (10 mm bins), ``segments``, ``scatterings``, ``energy`` (balance of an event
    source, keV), ``sensor_faces`` (columns), ``tallies`` (by name), ``wall_seconds``, ``complete``.
    """

    photons: int
    photons_requested: int
    photons_traced: int
    birth_efficiency: float
    complete: bool
    fate_count: np.ndarray
    detected_path_histogram: np.ndarray
    scatterings: int
    segments: int
    wall_seconds: float
    cut_bias_bound: float
    energy: Dict[str, Any]
    sensor_faces: Dict[str, np.ndarray]
    interactions: Moments
    detected_path_mm: Moments
    detected_time_ns: Moments
    detected_interactions: Moments

    def __init__(self, entry: Dict[str, Any], header: Dict[str, Any]) -> None:
        self.parameters: Dict[str, str] = dict(zip(header["sweep_keys"], entry["parameters"]))
        self.fate_names: List[str] = header["fates"]
        for name in ("photons", "photons_requested", "photons_traced", "birth_efficiency", "complete", "fate_count",
                     "detected_path_histogram", "scatterings", "segments", "wall_seconds", "cut_bias_bound", "energy",
                     "sensor_faces"):
            setattr(self, name, entry[name])
        if self.energy["events_requested"]:
            self.energy["detected_per_event"] = Moments(self.energy["detected_per_event"])
        for name in ("interactions", "detected_path_mm", "detected_time_ns", "detected_interactions"):
            setattr(self, name, Moments(entry[name]))
        self.fate_fraction: np.ndarray = entry["fate_fraction"]
        self.absorbed_in_medium: Dict[str, int] = dict(zip(header["media"], map(int, entry["absorbed_in_medium"])))
        self.absorbed_at_surface: Dict[str, int] = dict(zip(header["surfaces"], map(int, entry["absorbed_at_surface"])))
        self.tallies: Dict[str, Tally] = {}
        for tally in entry["tallies"]:
            name = tally["name"] or tally["type"]
            while name in self.tallies:
                name += "'"
            self.tallies[name] = Tally(tally)

    @property
    def fates(self) -> Dict[str, Estimate]:
        """Share of the emitted photons with each fate, with its standard error."""
        return {name: estimate(row) for name, row in zip(self.fate_names, self.fate_fraction)}

    @property
    def detected(self) -> Estimate:
        """Share of the emitted photons that were detected."""
        return self.fates["detected"]

    def tally(self, name: str) -> Tally:
        """A tally by name. Raises InputError with the names that exist."""
        if name not in self.tallies:
            raise names_hint("tally", name, list(self.tallies))
        return self.tallies[name]

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws the shares of the fates as bars with their errors. Returns the axes."""
        ax = axes_for(ax)
        shown = [i for i, count in enumerate(self.fate_count) if count]
        names = [self.fate_names[i].replace("_", " ") for i in shown]
        ax.barh(names, self.fate_fraction[shown, 0], xerr=self.fate_fraction[shown, 1])
        ax.invert_yaxis()
        ax.set_xlabel("share of the emitted photons")
        return ax

    def __repr__(self) -> str:
        label = ", ".join(f"{k} = {v}" for k, v in self.parameters.items())
        return f"Point({label + ': ' if label else ''}detected {self.detected} of {self.photons} photons)"

    def _repr_html_(self) -> str:
        return self._html("")

    def _html(self, before: str) -> str:
        """The table for notebooks, with a text before its title."""
        rows = [(name, int(n), str(f)) for (name, f), n in zip(self.fates.items(), self.fate_count) if n]
        return html_table(before + (", ".join(f"{k} = {v}" for k, v in self.parameters.items()) or "Fates of the photons"),
                          ("fate", "photons", "share"), rows)


class Results:
    """Results of a run, from memory or from a file.

    ``title``, ``version``, ``seed``, ``scene_text``, ``notes`` (warnings), ``media``, ``surfaces``, ``parts``,
    ``faces`` and ``fates`` (names), ``sweep_keys``; ``complete`` and ``partial_reason``. It is a sequence of its
    points. Arrays stay valid after ``close()``.
    """

    def __init__(self, core: Any) -> None:
        self._core = core
        self._header: Dict[str, Any] = core.header()
        self._points: List[Optional[Point]] = [None] * self._header["points"]
        self.title: str = self._header["title"]
        self.version: str = self._header["version"]
        self.seed: int = self._header["seed"]
        self.scene_file: str = self._header["scene_file"]
        self.scene_text: str = self._header["scene_text"]
        self.notes: List[str] = [note for note in self._header["note"].split("\n") if note]
        self.sweep_keys: List[str] = self._header["sweep_keys"]
        self.media: List[str] = self._header["media"]
        self.surfaces: List[str] = self._header["surfaces"]
        self.parts: List[str] = self._header["parts"]
        self.faces: List[str] = self._header["faces"]
        self.fates: List[str] = self._header["fates"]
        self.complete: bool = self._header["complete"]
        self.partial_reason: str = self._header["partial_reason"]

    def _open(self) -> Any:
        if self._core is None:
            raise ClosedError("the results were closed; open or run them again")
        return self._core

    def __len__(self) -> int:
        return len(self._points)

    @overload
    def __getitem__(self, number: int) -> Point: ...

    @overload
    def __getitem__(self, number: slice) -> List[Point]: ...

    def __getitem__(self, number: Union[int, slice]) -> Union[Point, List[Point]]:
        """The ``Point`` of a number, counted from the end if negative, or the list of those of a slice. Raises
        IndexError; InputError for a number that is not whole."""
        if isinstance(number, slice):
            return [self[i] for i in range(*number.indices(len(self)))]
        number = self._number(number)
        point = self._points[number]
        if point is None:
            point = self._points[number] = Point(self._open().point(number), self._header)
        return point

    def _number(self, number: Any) -> int:
        """The number of an existing point, from 0. Raises InputError for other types, IndexError for other
        numbers."""
        if isinstance(number, bool) or not isinstance(number, (int, np.integer)):
            raise InputError(f"the point is {number!r}; expected a whole number", "points count from 0")
        if not -len(self) <= number < len(self):
            raise IndexError(f"there is no point {number}; the results have {len(self)}")
        return int(number) % len(self)

    def __iter__(self) -> Iterator[Point]:
        return (self[i] for i in range(len(self)))

    @property
    def points(self) -> List[Point]:
        return list(self)

    @property
    def detected(self) -> np.ndarray:
        """Detected share and its standard error of every point (points, 2)."""
        return np.array([point.detected for point in self]).reshape(-1, 2)

    @property
    def photons(self) -> np.ndarray:
        """The detected photons, one record each, as a read-only view of the library's memory: ``point``,
        ``event``, ``photon``, ``part`` and ``face`` (indices into names), ``position_mm``, ``direction``,
        ``wavelength_nm``, ``time_ns``, ``path_mm``, ``interactions``. Raises InputError unless the scene has
        ``run.photon_list``."""
        core = self._open()
        if not self._header["photon_list"]:
            raise InputError("the run did not list its photons", 'set scene["run.photon_list"] = True and run again')
        return core.photons()

    def photons_dataframe(self) -> Any:
        """The detected photons as a DataFrame with units in ``attrs["units"]``. Raises as ``photons``, and
        MissingPackage without pandas."""
        photons = self.photons
        columns: Dict[str, Any] = {}
        for name in photons.dtype.names or ():
            if photons[name].ndim == 1:
                columns[name] = photons[name]
            else:
                stem = "direction_" if name == "direction" else ""
                for k, axis in enumerate("xyz"):
                    columns[f"{stem}{axis}" if stem else f"{axis}_mm"] = photons[name][:, k]
        units = {n: n.rsplit("_", 1)[1] if n.endswith(("_mm", "_nm", "_ns")) else "1" for n in columns}
        return dataframe(columns, units)

    def events(self, point: int = 0) -> Events:
        """The events of a point. Raises InputError for a source of photons, which has none."""
        entry = self._open().events(self._number(point))
        if entry is None:
            raise InputError("the run has no events: its source emits photons",
                             'use a source of the type "gamma_events", "gammas", "hits" or "photon_list"')
        return Events(entry, self.parts)

    def analyze(self, point: int = 0, settings: Optional[str] = None) -> "Analysis":
        """The ``Analysis`` of the events of a point: spectrum, photopeak, light against depth, depth of
        interaction, flood map, timing. ``settings`` is a text with [analysis] (docs/analysis.md) in place of
        the scene's. Raises InputError for wrong settings."""
        from .analysis import Analysis
        own = None if settings is None else text_of(settings, "settings")
        return Analysis(_core.analyze(self._open(), self._number(point), own))

    def to_dataframe(self) -> Any:
        """A DataFrame with one row per point: swept keys, photons, share and error of each fate."""
        rows = []
        for point in self:
            row: Dict[str, Any] = {**point.parameters, "photons": point.photons}
            for name, share in point.fates.items():
                row[name], row[f"{name}_error"] = share
            rows.append(row)
        frame = need("pandas", "a DataFrame").DataFrame(rows)
        frame.attrs["units"] = {name: "1" for name in frame.columns if name not in self.sweep_keys}
        return frame

    def to_xarray(self) -> Any:
        """A Dataset of ``fraction`` and ``error`` over ``point`` and ``fate``; swept keys are coordinates."""
        xarray = need("xarray", "to_xarray()")
        values = np.array([point.fate_fraction for point in self]).reshape(-1, len(self.fates), 2)
        coordinates: Dict[str, Any] = {"point": np.arange(len(self)), "fate": self.fates}
        for key in self.sweep_keys:
            coordinates[key] = ("point", [point.parameters[key] for point in self])
        return xarray.Dataset({"fraction": (("point", "fate"), values[:, :, 0], {"units": "1"}),
                               "error": (("point", "fate"), values[:, :, 1], {"units": "1"})},
                              coordinates, {"title": self.title, "seed": self.seed})

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws the fates of a single point, or the detected share against the last swept key, a curve for each
        combination of the others. Returns the axes."""
        if len(self) == 1:
            return self[0].plot(ax)
        ax = axes_for(ax)
        curves: Dict[str, List[Point]] = {}
        for point in self:
            label = ", ".join(list(point.parameters.values())[:-1])
            curves.setdefault(label, []).append(point)
        for label, points in curves.items():
            x = _positions([list(p.parameters.values())[-1] for p in points])
            ax.errorbar(x, [p.detected.value for p in points], [p.detected.error for p in points], fmt="o-",
                        markersize=3, capsize=2, label=label or None)
        ax.set_xlabel(self.sweep_keys[-1])
        ax.set_ylabel("detected share of the emitted photons")
        if len(curves) > 1:
            ax.legend()
        return ax

    def close(self) -> None:
        """Releases the data; arrays that are in use stay valid."""
        self._core = None

    def __enter__(self) -> "Results":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "" if self.complete else f", partial: {self.partial_reason}"
        return f"Results({self.title!r}, {len(self)} point{'s' if len(self) != 1 else ''}{state})"

    def _repr_html_(self) -> str:
        if len(self) == 1:
            return self[0]._html(f"{self.title}: ")
        rows = [(*p.parameters.values(), p.photons, str(p.detected)) for p in self]
        return html_table(self.title, (*self.sweep_keys, "photons", "detected"), rows,
                          "" if self.complete else f"partial: {self.partial_reason}")


def _positions(values: Sequence[str]) -> Any:
    """Numbers of texts such as "2 mm" where all have the same unit, else the texts."""
    words = [value.split() for value in values]
    try:
        if len({tuple(w[1:]) for w in words}) == 1:
            return [float(w[0]) for w in words]
    except (ValueError, IndexError):
        pass
    return list(values)


def open_results(path: Union[str, "os.PathLike[str]"]) -> Results:
    """The results of a file (HDF5) of ``scintray run`` or ``run(output=...)``.

    Raises InputError for a file that is missing, is not a result, or is of an unknown version.
    """
    return Results(_core.open_results(path_text(path)))
