"""Runs of a scene in memory."""

from __future__ import annotations

import os
import sys
import time
from typing import Any, Callable, Dict, List, Optional, Union

import numpy as np

from . import _core
from ._checks import flag, numbers, one_of, path_text, positive_integer, thread_count, whole, whole_or_none
from ._tools import Shown, axes_for, dataframe, html_table
from .errors import Cancelled, ClosedError, InputError, Problem
from .results import Results
from .scene import PLANES, Scene, as_scene, draw_edges

__all__ = ["Deposits", "PhotonList", "ProgressBar", "Simulation"]

Progress = Union[None, bool, Callable[[int, int, str], Any]]

_LENGTHS_MM = {"nm": 1e-6, "um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0}
_ENERGIES_KEV = {"eV": 1e-3, "keV": 1.0, "MeV": 1e3}
_TIMES_NS = {"ps": 1e-3, "ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def _factor(units: Dict[str, float], unit: str, what: str) -> float:
    if not isinstance(unit, str) or unit not in units:
        raise InputError(f"{unit!r} is not a unit of {what}", "it is one of " + ", ".join(units))
    return units[unit]


_HC_EV_NM = 1239.8419843320026  # exact SI values, CODATA 2018

_STEP_COLUMNS = ("beta", "beta_end", "charge", "particle", "kinetic", "scintillation_photons", "cherenkov_photons",
                 "decay", "rise")


class Deposits(Shown):
    """Energy deposits of another program: one row each, rows of one event number are one event.

    Parameters
    ----------
    event : (n,) whole numbers from 0
    position : (n, 3) in ``length_unit``, in the coordinates of the scene
    energy : (n,) in ``energy_unit``, from 0
    time : (n,) in ``time_unit``; relative to the first deposit of each event; None: simultaneous
    displacement : (n, 3) in ``length_unit``, to the end of a particle's step; None: deposits are points
    steps : further columns of steps, (n,) each: ``beta``, ``beta_end`` (velocities over that of light), ``charge``,
        ``particle`` (codes of the Particle Data Group), ``kinetic`` (energy at the start, in ``energy_unit``),
        ``scintillation_photons``, ``cherenkov_photons``, ``decay``, ``rise`` (in ``time_unit``); docs/gamma_sources.md

    Raises InputError for other shapes, numbers that are not finite, negative energies, and unknown units.
    """

    def __init__(self, event: Any, position: Any, energy: Any, time: Any = None, *, displacement: Any = None,
                 length_unit: str = "mm", energy_unit: str = "keV", time_unit: str = "ns", **steps: Any) -> None:
        self.event = numbers(event, "event", (-1,))
        rows = len(self.event)
        if rows == 0:
            raise InputError("there are no deposits", "give one row at least")
        self.position_mm = numbers(position, "position", (rows, 3), length_unit) \
            * _factor(_LENGTHS_MM, length_unit, "length")
        self.energy_keV = numbers(energy, "energy", (rows,), energy_unit) \
            * _factor(_ENERGIES_KEV, energy_unit, "energy")
        factor = _factor(_TIMES_NS, time_unit, "time")
        self.time_ns = np.zeros(0) if time is None else numbers(time, "time", (rows,), time_unit) * factor
        factors = {"kinetic": (energy_unit, _ENERGIES_KEV[energy_unit]), "decay": (time_unit, factor),
                   "rise": (time_unit, factor)}
        self.steps: Dict[str, Any] = {}
        for name, column in steps.items():
            if name not in _STEP_COLUMNS:
                raise InputError(f"{name!r} is not a column of steps", "it is one of " + ", ".join(_STEP_COLUMNS))
            unit, scale = factors.get(name, ("1", 1.0))
            self.steps[name] = numbers(column, name, (rows,), unit) * scale
        if displacement is not None:
            moved = numbers(displacement, "displacement", (rows, 3), length_unit) * _LENGTHS_MM[length_unit]
            for axis, name in enumerate(("dx", "dy", "dz")):
                self.steps[name] = np.ascontiguousarray(moved[:, axis])
        wrong = np.flatnonzero((self.event < 0) | (self.event != np.floor(self.event)))
        if len(wrong):
            raise InputError(f"event[{wrong[0]}] is {self.event[wrong[0]]}; expected a whole number from 0 on",
                             "number the events 0, 1, 2, ...")
        wrong = np.flatnonzero(self.energy_keV < 0)
        if len(wrong):
            raise InputError(f"energy[{wrong[0]}] is {self.energy_keV[wrong[0]]} keV, which is negative",
                             "give energies from 0 on")

    def __len__(self) -> int:
        return len(self.event)

    def to_dataframe(self) -> Any:
        """A DataFrame with one row per deposit; units in ``attrs["units"]``."""
        columns: Dict[str, Any] = {"event": self.event.astype(np.int64), "energy_keV": self.energy_keV}
        for k, axis in enumerate("xyz"):
            columns[f"{axis}_mm"] = self.position_mm[:, k]
        if len(self.time_ns):
            columns["time_ns"] = self.time_ns
        return dataframe(columns, {"event": "1", "energy_keV": "keV", "x_mm": "mm", "y_mm": "mm", "z_mm": "mm",
                                   "time_ns": "ns"})

    def plot(self, ax: Optional[Any] = None, *, plane: str = "xz") -> Any:
        """Draws the deposits, projected onto a plane ("xy", "xz" or "yz"), coloured by their energy."""
        return _draw_points(ax, plane, self.position_mm, self.energy_keV, "energy (keV)")

    def _rows(self) -> Any:
        return [("deposits", len(self)), ("events", len(np.unique(self.event))),
                ("energy (keV)", f"{self.energy_keV.sum():.6g}")] + _ranges(self.position_mm)

    def __repr__(self) -> str:
        return (f"Deposits({len(self)} in {len(np.unique(self.event))} events, "
                f"{self.energy_keV.sum():.6g} keV)")


class PhotonList(Shown):
    """Photons of another program: one row each, rows of one event number are one event.

    Raises InputError for other shapes, numbers that are not finite, and unknown units; other errors are
    reported, with their rows, when the scene is built (docs/gamma_sources.md).

    Parameters
    ----------
    position : (n, 3) in ``length_unit``, in the coordinates of the scene
    direction : (n, 3), of any length above 0
    wavelength : (n,) in ``wavelength_unit``, in vacuum; or ``energy`` in its place
    energy : (n,) in ``energy_unit``
    event : (n,) whole numbers from 0; None: the scene's source has ``photons_per_event``
    time : (n,) in ``time_unit``; None: all at 0
    polarisation : (n, 3), of any length; for a row of zeros, or None, drawn at random perpendicular to the
        direction
    """

    def __init__(self, position: Any, direction: Any, wavelength: Any = None, *, energy: Any = None, event: Any = None,
                 time: Any = None, polarisation: Any = None, length_unit: str = "mm", wavelength_unit: str = "nm",
                 energy_unit: str = "eV", time_unit: str = "ns") -> None:
        position = numbers(position, "position", (-1, 3), length_unit) * _factor(_LENGTHS_MM, length_unit, "length")
        rows = len(position)
        if rows == 0:
            raise InputError("there are no photons", "give one row at least")
        if (wavelength is None) == (energy is None):
            raise InputError("photons have a wavelength or an energy", "give one of both")
        self.columns: Dict[str, Any] = {}

        def set_vector(name: str, values: Any) -> None:
            for axis, letter in enumerate("xyz"):
                self.columns[f"{name}{letter}"] = np.ascontiguousarray(values[:, axis])

        set_vector("", position)
        set_vector("direction_", numbers(direction, "direction", (rows, 3)))
        if polarisation is not None:
            set_vector("polarisation_", numbers(polarisation, "polarisation", (rows, 3)))
        if wavelength is not None:
            factor = _factor(_LENGTHS_MM, wavelength_unit, "wavelength")
            self.columns["wavelength"] = numbers(wavelength, "wavelength", (rows,), wavelength_unit) * (factor * 1e6)
        else:
            electronvolts = numbers(energy, "energy", (rows,), energy_unit) \
                * (_factor(_ENERGIES_KEV, energy_unit, "energy") * 1e3)
            wrong = np.flatnonzero(electronvolts <= 0)
            if len(wrong):
                raise InputError(f"energy[{wrong[0]}] is {electronvolts[wrong[0]]} eV; expected one above 0")
            self.columns["wavelength"] = _HC_EV_NM / electronvolts
        if event is not None:
            self.columns["event"] = numbers(event, "event", (rows,))
        if time is not None:
            self.columns["time"] = numbers(time, "time", (rows,), time_unit) * _factor(_TIMES_NS, time_unit, "time")

    def __len__(self) -> int:
        return len(self.columns["x"])

    @property
    def position_mm(self) -> np.ndarray:
        """Starting points of the photons (n, 3), mm."""
        return np.column_stack([self.columns[axis] for axis in "xyz"])

    def plot(self, ax: Optional[Any] = None, *, plane: str = "xz") -> Any:
        """Draws the starting points, projected onto a plane ("xy", "xz" or "yz"), coloured by wavelength."""
        return _draw_points(ax, plane, self.position_mm, self.columns["wavelength"], "wavelength (nm)")

    def _rows(self) -> Any:
        nm = self.columns["wavelength"]
        return [("photons", len(self)), ("wavelength (nm)", f"{nm.min():.6g} to {nm.max():.6g}")] \
            + _ranges(self.position_mm)

    def __repr__(self) -> str:
        nm = self.columns["wavelength"]
        return f"PhotonList({len(self)} photons of {nm.min():.6g} to {nm.max():.6g} nm)"


def _ranges(position_mm: np.ndarray) -> List[Any]:
    return [(f"{axis} (mm)", f"{position_mm[:, k].min():.6g} to {position_mm[:, k].max():.6g}")
            for k, axis in enumerate("xyz")]


def _draw_points(ax: Optional[Any], plane: str, position_mm: np.ndarray, value: np.ndarray, label: str) -> Any:
    x, y = ("xyz".index(axis) for axis in one_of(plane, "plane", PLANES))
    ax = axes_for(ax)
    points = ax.scatter(position_mm[:, x], position_mm[:, y], c=value, s=4, rasterized=True)
    ax.set_aspect("equal")
    ax.set_xlabel(f"{plane[0]} (mm)")
    ax.set_ylabel(f"{plane[1]} (mm)")
    ax.figure.colorbar(points, ax=ax, label=label)
    return ax


class ProgressBar:
    """Share, rate and time left on standard error, for ``run(progress=True)``.

    On a terminal and in a notebook one line, written again at every call. Elsewhere, as in the log of a batch job, a
    line of its own every ``interval_s``, so that short work leaves none.

    Parameters
    ----------
    stream : standard error if not given
    rewrites : whether the stream shows a line that is written again; found out if not given
    interval_s : seconds between lines of a log
    """

    def __init__(self, stream: Any = None, rewrites: Optional[bool] = None, interval_s: float = 60.0) -> None:
        self._stream = stream if stream is not None else sys.stderr
        if rewrites is None:
            rewrites = self._stream.isatty() or "ipykernel" in sys.modules
        self._rewrites = rewrites
        self._interval_s = interval_s
        self._start = time.monotonic()
        self._last = self._start
        self._width = 0

    def __call__(self, done: int, of: int, thing: str) -> None:
        now = time.monotonic()
        if not self._rewrites and now - self._last < self._interval_s:
            return
        self._last = now
        elapsed = now - self._start
        share = f"{100.0 * done / of:3.0f} %  " if of else ""
        line = f"{share}{done} {thing}"
        if of and 0 < done < of and elapsed > 0.0 and not thing.startswith("%"):
            line += f", {done / elapsed:.3g}/s, {(of - done) * elapsed / done:.0f} s left"
        self._stream.write("\r" + line.ljust(self._width) if self._rewrites else line + "\n")
        self._stream.flush()
        self._width = len(line) if self._rewrites else 0

    def close(self) -> None:
        """Removes the line that is written again."""
        if self._width:
            self._stream.write("\r" + " " * self._width + "\r")
            self._stream.flush()
            self._width = 0


def with_source(error: InputError, text: str, file: str) -> InputError:
    """The error with the line of the scene's text in each problem, as a scene made in Python has no file."""
    lines = text.splitlines()
    for problem in error.problems:
        if isinstance(problem, Problem) and problem.file == file and 0 < problem.line <= len(lines):
            problem.source = lines[problem.line - 1]
    return InputError(error.problems)


def watched(progress: Progress, work: Callable[[Optional[Callable[[int, int, str], Any]]], Any]) -> Any:
    """Result of ``work``, called with the progress function: None, the caller's, or a bar. Raises InputError
    for others."""
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise InputError(f"progress is {progress!r}; expected True, or a function",
                         "write progress=True, or progress=f with f(done, of, thing)")
    bar = ProgressBar() if progress is True else None
    call = bar if bar is not None else progress if callable(progress) else None
    try:
        return work(call)
    finally:
        if bar is not None:
            bar.close()


class Simulation:
    """A scene that can be run any number of times, with the same result each time.

    Parameters
    ----------
    scene : Scene, or the path of a scene file
    threads : number of threads (default: all cores); no result depends on it
    seed, photons, events : in place of the scene's, per point of its sweep
    quick : the scene's quick_photons or quick_events in place of its full number

    A run is bit-identical to ``scintray run`` of the same scene. A simulation may be used by one thread of
    Python at a time; the interpreter's lock is released during tracing, so that other threads continue.

    Raises InputError with all mistakes of the scene; methods raise ClosedError after ``close()``.
    """

    def __init__(self, scene: Union[Scene, str, "os.PathLike[str]"], *, threads: Optional[int] = None,
                 seed: Optional[int] = None, photons: Optional[int] = None, events: Optional[int] = None,
                 quick: bool = False) -> None:
        self.scene = as_scene(scene).copy()
        self.text, self.file = self.scene.text, self.scene.file
        self._core: Any = self._guard(lambda: _core.Session(
            self.text, self.file, thread_count(threads), whole_or_none(seed, "seed"),
            positive_integer(photons, "photons"), positive_integer(events, "events"), flag(quick, "quick")))

    def _guard(self, work: Callable[[], Any]) -> Any:
        try:
            return work()
        except InputError as error:
            raise with_source(error, self.text, self.file) from None

    def _open(self) -> Any:
        if self._core is None:
            raise ClosedError("the simulation was closed; make another one of the scene")
        return self._core

    @property
    def points(self) -> int:
        """Number of points of the sweep; 1 without a sweep."""
        return self._open().points()

    def parameters(self, point: int = 0) -> Dict[str, str]:
        """Values of the swept keys at a point, as written in the scene."""
        core = self._open()
        return dict(zip(core.sweep_keys(), core.parameters(_index(point))))

    def check(self) -> List[str]:
        """Builds the scene and returns its warnings. Raises InputError with all mistakes of the scene."""
        core = self._open()
        return self._guard(core.check)

    def parts(self, point: int = 0) -> List[Dict[str, Any]]:
        """The parts as placed: name, medium, sensor, ``vertices`` (n, 3) in mm, ``triangles`` (m, 3), the face of
        each triangle, and names and surfaces of faces; arrays are views, not copies."""
        core = self._open()
        return self._guard(lambda: core.parts(_index(point)))

    def run(self, *, progress: Progress = None, output: Union[str, "os.PathLike[str]", None] = None,
            deposits: Optional[Deposits] = None, photon_list: Optional[PhotonList] = None) -> Results:
        """Traces all points and returns the results.

        Parameters
        ----------
        progress : True for a bar, or a function of (done, of, thing), called in this thread about 20 times a
            second at most; the run stops when it returns False, and the results are partial
        output : path of a results file (HDF5); photon lists and events are then read from it when needed,
            instead of being kept in memory
        deposits : of a scene whose source is ``{"type": "hits", "arrays": True}``
        photon_list : of a scene whose source is ``{"type": "photon_list", "arrays": True}``

        Raises InputError; SystemFailure; Cancelled on Ctrl-C, with the partial results; and exceptions of the
        progress function.
        """
        core = self._open()
        if deposits is not None:
            if not isinstance(deposits, Deposits):
                raise InputError(f"deposits is of the type {type(deposits).__name__}",
                                 "give Deposits(event, position, energy, time)")
            hits = deposits
            self._guard(lambda: core.set_hits(hits.event, hits.position_mm, hits.energy_keV, hits.time_ns, hits.steps))
        if photon_list is not None:
            if not isinstance(photon_list, PhotonList):
                raise InputError(f"photon_list is of the type {type(photon_list).__name__}",
                                 "give PhotonList(position, direction, wavelength)")
            columns = photon_list.columns
            self._guard(lambda: core.set_photons(columns))
        path = None if output is None else path_text(output, "output")
        data, raised = self._guard(lambda: watched(progress, lambda call: core.run(call, path)))
        results = Results(data)
        if isinstance(raised, KeyboardInterrupt):
            raise Cancelled("stopped by Ctrl-C; the photons traced so far are in the results of this exception",
                            results) from raised
        if raised is not None:
            raise raised
        return results

    def plot(self, ax: Optional[Any] = None, *, plane: str = "xz", point: int = 0) -> Any:
        """Draws the edges of the placed parts, projected onto a plane ("xy", "xz" or "yz"), mm."""
        one_of(plane, "plane", PLANES)
        parts = self.parts(point)
        ax = axes_for(ax)
        colours: Dict[str, str] = {}
        for part in parts:
            medium = part["medium"] or f"sensor {part['sensor']}"
            new = medium not in colours
            colours.setdefault(medium, f"C{len(colours) % 10}")
            draw_edges(ax, plane, part["vertices"], part["triangles"], color=colours[medium],
                       label=medium if new else None)
        ax.legend(loc="upper right", fontsize="small")
        ax.set_title(str(self.scene.data.get("title", "")))
        return ax

    def close(self) -> None:
        """Releases the scene; results remain valid."""
        self._core = None

    def __enter__(self) -> "Simulation":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def _repr_html_(self) -> str:
        if self._core is None:
            return html_table("Simulation", ("", ""), [("state", "closed")])
        shown = range(min(self.points, 20))
        rows = [(i, *self.parameters(i).values()) for i in shown]
        more = f"; {self.points - 20} more points" if self.points > 20 else ""
        return html_table(f"Simulation: {self.scene.data.get('title', '')}", ("point", *self._core.sweep_keys()), rows,
                          self.file + more)

    def __repr__(self) -> str:
        state = "closed" if self._core is None else f"{self.points} point{'s' if self.points > 1 else ''}"
        return f"Simulation({self.scene.data.get('title', '')!r}, {state})"


def _index(point: Any) -> int:
    return whole(point, "point")
