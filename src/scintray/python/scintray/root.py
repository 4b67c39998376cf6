"""Import of lists of hits and of photons from ROOT files, export of detected photons to them, by the optional
package uproot."""

from __future__ import annotations

import difflib
import importlib
import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

import numpy as np

from ._checks import path_text, text_of
from .errors import InputError, MissingPackage
from .results import Results
from .simulation import Deposits, PhotonList

__all__ = ["read_root_hits", "read_root_photons", "write_root_photons"]

# Branches of GATE's trees of hits, with their units: those of GATE 9, and of GATE 10, whose own tools for tests compare
# both with the factor 1e-9 for the time and 1 for positions and energies (opengate, tests/utility.py).
_LAYOUTS: Dict[str, Dict[str, Any]] = {
    "GATE 9": {"columns": {"event": "eventID", "x": "posX", "y": "posY", "z": "posZ", "energy": "edep", "time": "time"},
               "run": "runID", "time_unit": "s"},
    "GATE 10": {"columns": {"event": "EventID", "x": "PostPosition_X", "y": "PostPosition_Y", "z": "PostPosition_Z",
                            "energy": "TotalEnergyDeposit", "time": "GlobalTime"},
                "run": "RunID", "time_unit": "ns"},
}
_REQUIRED = ("event", "x", "y", "z", "energy")

# Branches of GATE's phase spaces, in Geant4's units (mm, MeV, ns): of GATE 9 (GatePhaseSpaceActor.cc), and of GATE 10
# (GateDigiAttributeList.cpp) at the beginning of the step.
_PHOTON_LAYOUTS: Dict[str, Dict[str, Any]] = {
    "GATE 9": {"columns": {"event": "EventID", "x": "X", "y": "Y", "z": "Z", "dx": "dX", "dy": "dY", "dz": "dZ",
                           "energy": "Ekine", "time": "Time"}},
    "GATE 10": {"columns": {"event": "EventID", "x": "PrePosition_X", "y": "PrePosition_Y", "z": "PrePosition_Z",
                            "dx": "PreDirection_X", "dy": "PreDirection_Y", "dz": "PreDirection_Z",
                            "energy": "KineticEnergy", "time": "PreGlobalTime"}},
}
_PHOTON_REQUIRED = ("x", "y", "z", "dx", "dy", "dz")
_RUN, _PARTICLE, _PHOTON = "RunID", "ParticleName", "opticalphoton"


def _uproot(what: str) -> Any:
    try:
        return importlib.import_module("uproot")
    except ImportError as error:
        raise MissingPackage(f"{what} needs uproot, which is not installed; hint: pip install uproot "
                             "(Debian 12 has no package of it)") from error


def _branches(tree: Any) -> List[str]:
    return [str(name) for name in tree.keys()]


def _layout_of(layouts: Dict[str, Dict[str, Any]], required: Sequence[str], branches: List[str],
               where: str) -> Dict[str, Any]:
    for layout in layouts.values():
        if all(layout["columns"][name] in branches for name in required):
            return layout
    raise InputError(f"{where} has neither GATE 9's nor GATE 10's branches; it has " + ", ".join(branches),
                     "name them: columns={" + ", ".join(f'"{name}": "..."' for name in required) + "}")


def _tree_of(file: Any, tree: str, path: str) -> Any:
    trees = sorted({str(name).split(";")[0] for name in file.keys()})
    if tree not in trees:
        near = difflib.get_close_matches(tree, trees, 1)
        raise InputError(f"{path} has no tree {tree!r}",
                         (f"did you mean {near[0]!r}? " if near else "") + "it has " + ", ".join(trees))
    return file[tree]


def _require_branches(wanted: Sequence[str], branches: List[str], where: str) -> None:
    for branch in wanted:
        if branch not in branches:
            raise InputError(f"{where} has no branch {branch!r}", "it has " + ", ".join(branches))


def _named(columns: Mapping[str, str], required: Sequence[str], hint: str) -> Dict[str, str]:
    """The branches that a user names."""
    missing = [name for name in required if name not in columns]
    if missing:
        raise InputError("columns names no branch for " + ", ".join(missing), hint)
    return dict(columns)


def _events_of_runs(run: Any, event: Any) -> Any:
    """Numbers of events that differ where the run or the event does."""
    pairs = np.column_stack([np.asarray(run), np.asarray(event)])
    return np.unique(pairs, axis=0, return_inverse=True)[1].reshape(-1)


def read_root_hits(path: Union[str, "os.PathLike[str]"], tree: str = "Hits", *,
                   columns: Optional[Mapping[str, str]] = None, run: Optional[str] = None, length_unit: str = "mm",
                   energy_unit: str = "MeV", time_unit: Optional[str] = None) -> Deposits:
    """Energy deposits of a tree of hits, for ``run(deposits=...)``.

    Raises MissingPackage without uproot; InputError for a missing tree or missing branches.

    Parameters
    ----------
    path : ROOT file
    tree : name of its tree
    columns : branch of each of ``event``, ``x``, ``y``, ``z``, ``energy``, and optionally of ``time``,
        ``dx``, ``dy``, ``dz`` and the other columns of steps of ``Deposits``; None: those of GATE 9 or GATE 10,
        whichever the tree has
    run : branch with the number of the run; equal event numbers in different runs are different events. None:
        GATE's, if the tree has it
    length_unit, energy_unit : of the tree; mm and MeV, as GATE and Geant4 write
    time_unit : of the tree; None: s for GATE 9, ns for GATE 10 and for ``columns``
    """
    path, tree = path_text(path), text_of(tree, "tree")
    uproot = _uproot("read_root_hits()")
    with uproot.open(path) as file:
        hits = _tree_of(file, tree, path)
        branches = _branches(hits)
        where = f"the tree {tree!r} of {path}"
        if columns is None:
            layout = _layout_of(_LAYOUTS, _REQUIRED, branches, where)
            names = {name: branch for name, branch in layout["columns"].items() if branch in branches}
            run = run or (layout["run"] if layout["run"] in branches else None)
            time_unit = time_unit or layout["time_unit"]
        else:
            names = _named(columns, _REQUIRED, "event, x, y, z and energy are needed")
        _require_branches([*names.values(), *([run] if run else [])], branches, where)
        read = hits.arrays([*names.values(), *([run] if run else [])], library="np")
    data = {name: np.asarray(read[branch]) for name, branch in names.items()}
    event = data.pop("event")
    if run:
        event = _events_of_runs(read[run], event)
    position = np.column_stack([data.pop(axis) for axis in "xyz"])
    moved: List[Any] = [data.pop(name, None) for name in ("dx", "dy", "dz")]
    if any(column is None for column in moved) and not all(column is None for column in moved):
        raise InputError("columns names one or two of dx, dy, dz", "name all three, or none")
    return Deposits(event, position, data.pop("energy"), data.pop("time", None),
                    displacement=None if moved[0] is None else np.column_stack(moved), length_unit=length_unit,
                    energy_unit=energy_unit, time_unit=time_unit or "ns", **data)


def read_root_photons(path: Union[str, "os.PathLike[str]"], tree: str = "PhaseSpace", *,
                      columns: Optional[Mapping[str, str]] = None, run: Optional[str] = None,
                      particle: Optional[str] = None, length_unit: str = "mm", energy_unit: str = "MeV",
                      wavelength_unit: str = "nm", time_unit: str = "ns") -> PhotonList:
    """Optical photons of a tree, for ``run(photon_list=...)``: a phase space of GATE 9 or GATE 10, or an ntuple of a
    Geant4 program.

    Raises MissingPackage without uproot; InputError for a missing tree or missing branches, and as ``PhotonList``.

    Parameters
    ----------
    path : ROOT file
    tree : name of its tree
    columns : branch of each of ``x``, ``y``, ``z``, ``dx``, ``dy``, ``dz``, of ``energy`` or ``wavelength``, and
        optionally of ``event``, ``time``, and all of ``ex``, ``ey``, ``ez`` (polarisation); None: those of a phase
        space of GATE 9, or of GATE 10 with PrePosition, PreDirection and KineticEnergy
    run : branch with the number of the run; equal event numbers in different runs are different events. None:
        GATE's, if the tree has it and ``columns`` is None
    particle : branch with the name of the particle, of which rows other than "opticalphoton" are left out. None: as
        ``run``
    length_unit, energy_unit, wavelength_unit, time_unit : of the tree; the defaults are Geant4's
    """
    path, tree = path_text(path), text_of(tree, "tree")
    uproot = _uproot("read_root_photons()")
    with uproot.open(path) as file:
        rows = _tree_of(file, tree, path)
        branches = _branches(rows)
        where = f"the tree {tree!r} of {path}"
        if columns is None:
            layout = _layout_of(_PHOTON_LAYOUTS, (*_PHOTON_REQUIRED, "energy"), branches, where)
            names = {name: branch for name, branch in layout["columns"].items() if branch in branches}
            run = run or (_RUN if _RUN in branches and "event" in names else None)
            particle = particle or (_PARTICLE if _PARTICLE in branches else None)
        else:
            names = _named(columns, _PHOTON_REQUIRED, "x, y, z, dx, dy, dz and energy or wavelength are needed")
        extra = [branch for branch in (run, particle) if branch]
        _require_branches([*names.values(), *extra], branches, where)
        read = rows.arrays([*names.values(), *extra], library="np")
    kept: Any = slice(None)
    if particle:
        kept = np.asarray([str(name) == _PHOTON for name in read[particle]])
        if not kept.any():
            raise InputError(f"{where} has no row whose {particle} is {_PHOTON!r}",
                             "write the optical photons, or name the branch: particle=\"...\"")
    data = {name: np.asarray(read[branch])[kept] for name, branch in names.items()}
    event = data.get("event")
    if run and event is not None:
        event = _events_of_runs(np.asarray(read[run])[kept], event)

    def vector(letters: Sequence[str]) -> Any:
        return np.column_stack([data[letter] for letter in letters])

    polarised = [name for name in ("ex", "ey", "ez") if name in data]
    if polarised and len(polarised) != 3:
        raise InputError("columns names one or two of ex, ey, ez", "name all three, or none")
    return PhotonList(vector("xyz"), vector(("dx", "dy", "dz")), data.get("wavelength"), energy=data.get("energy"),
                      event=event, time=data.get("time"), polarisation=vector(polarised) if polarised else None,
                      length_unit=length_unit, wavelength_unit=wavelength_unit, energy_unit=energy_unit,
                      time_unit=time_unit)


def write_root_photons(results: Results, path: Union[str, "os.PathLike[str]"], tree: str = "photons") -> int:
    """Writes the detected photons of a run (``photon_list = true``) as a tree, a branch for each column, in mm,
    nm, ns.

    Returns the number of photons. Raises MissingPackage without uproot, and as ``Results.photons``.
    """
    path, tree = path_text(path), text_of(tree, "tree")
    uproot = _uproot("write_root_photons()")
    photons = results.photons
    branches: Dict[str, Any] = {}
    for name in photons.dtype.names:
        column = photons[name]
        if column.ndim == 1:
            branches[name] = np.ascontiguousarray(column)
        else:
            for axis, letter in enumerate("xyz"):
                own = f"direction_{letter}" if name == "direction" else f"{letter}_mm"
                branches[own] = np.ascontiguousarray(column[:, axis])
    with uproot.recreate(path) as file:
        file[tree] = branches
    return len(photons)
