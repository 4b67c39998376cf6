"""ScintRay: transport of scintillation light in detectors whose parts are arbitrary triangle meshes.

>>> import scintray
>>> scene = scintray.Scene.load("first.toml")
>>> scene["source.photons"] = 10_000
>>> results = scene.run(progress=True)
>>> results[0].detected
Estimate(value=0.07..., error=0.0026...)

docs/python.md is the guide. Lengths are mm, wavelengths nm, times ns, energies keV; every name of a raw number ends
in its unit. Errors are of the classes of ``scintray.errors``.
"""

import os as _os

# A package installed by pip contains the data; the library locates those of other installations.
_data = _os.path.join(_os.path.dirname(_os.path.abspath(__file__)), "data")
if _os.path.isdir(_data):
    _os.environ.setdefault("SCINTRAY_DATA", _data)

from . import errors
from ._core import data_folder as _data_folder
from ._core import version as _version
from ._tools import Estimate
from .analysis import Analysis
from .errors import (Cancelled, ClosedError, Error, InputError, InternalError, MissingPackage, Problem,
                     SystemFailure)
from .mapping import Fit, ResponseMap, fit, reweight
from .results import Events, Point, Results, open_results
from .root import read_root_hits, read_root_photons, write_root_photons
from .scene import Mesh, Scene, quantity
from .simulation import Deposits, PhotonList, ProgressBar, Simulation
from .surfaces import Goniometer, HeightMap, Medium, SurfaceTable, goniometer, media, names, surfaces
from .tallies import Tally

__version__: str = _version()

__all__ = ["Analysis", "Cancelled", "ClosedError", "Deposits", "Error", "Estimate", "Events", "Fit", "Goniometer",
           "HeightMap", "InputError", "InternalError", "Medium", "Mesh", "MissingPackage", "PhotonList", "Point", "Problem",
           "ProgressBar", "ResponseMap", "Results", "Scene", "Simulation", "SurfaceTable", "SystemFailure", "Tally",
           "data_folder", "errors", "fit", "goniometer", "media", "names", "open_results", "quantity",
           "read_root_hits", "read_root_photons", "reweight", "surfaces", "write_root_photons"]


def data_folder() -> str:
    """Path of the folder of the data shipped with ScintRay: materials, scenes, geometry."""
    return _data_folder()
