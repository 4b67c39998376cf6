"""Media, surfaces on the goniometer, surface tables and height maps."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._checks import flag, index_of, names_hint, number, numbers, one_of, path_text, text_of, whole
from ._tools import Estimate, axes_for, dataframe, estimate, html_table, need
from .errors import InputError
from .simulation import Progress, watched

__all__ = ["Goniometer", "HeightMap", "Medium", "SurfaceTable", "goniometer", "media", "names", "surfaces"]

PathLike = Union[str, "os.PathLike[str]"]
_MOST_POINTS = 16384  # of an edge of a map
_SIDES = ("inside", "outside")
_KINDS = ("media", "surfaces", "sensors", "reflectors")


def names(kind: str, definitions: str = "") -> List[str]:
    """Names in the material database: of "media", "surfaces", "sensors" or "reflectors". ``definitions`` is a text
    with further ones ([surfaces.NAME], ...). Raises InputError for another kind."""
    if kind not in _KINDS:
        raise names_hint("kind of definitions", kind, _KINDS)
    return _core.definitions(kind, text_of(definitions, "definitions"))


def media() -> List[str]:
    """Names of the media of the material database."""
    return names("media")


def surfaces() -> List[str]:
    """Names of the surfaces of the material database."""
    return names("surfaces")


class Medium:
    """Optical properties of a medium of the material database at wavelengths (nm).

    ``wavelength_nm``, ``index``, ``group_index``, ``absorption_length_mm`` and ``scattering_length_mm`` (inf: none),
    ``emission`` (relative number of photons per nm), all (n,); ``yield_per_keV``, ``density_g_per_cm3`` (0: not
    stated), ``decay`` (decay ns, rise ns, share of the light), ``sources``.

    Raises InputError for an unknown name, with the nearest, and for wavelengths that are not positive.
    """

    index: np.ndarray
    group_index: np.ndarray
    absorption_length_mm: np.ndarray
    scattering_length_mm: np.ndarray
    emission: np.ndarray
    yield_per_keV: float
    density_g_per_cm3: float
    decay: List[Tuple[float, float, float]]
    sources: List[str]

    def __init__(self, name: str, wavelength_nm: Any = None, definitions: str = "") -> None:
        self.name = text_of(name, "name")
        self.wavelength_nm = numbers(np.arange(350.0, 651.0, 5.0) if wavelength_nm is None
                                     else np.atleast_1d(wavelength_nm), "wavelength_nm", (-1,), "nm")
        if (self.wavelength_nm <= 0).any():
            raise InputError("a wavelength is not positive", "give wavelengths in nm")
        self.__dict__.update(_core.medium(name, self.wavelength_nm.tolist(), text_of(definitions, "definitions")))

    def to_dataframe(self) -> Any:
        """A DataFrame with units in ``attrs["units"]``."""
        columns = ("wavelength_nm", "index", "group_index", "absorption_length_mm", "scattering_length_mm", "emission")
        return dataframe({name: getattr(self, name) for name in columns},
                         {"wavelength_nm": "nm", "absorption_length_mm": "mm", "scattering_length_mm": "mm",
                          "index": "1", "group_index": "1", "emission": "1/nm"})

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws the refractive index and, if the medium scintillates, its emission. Returns the axes."""
        ax = axes_for(ax)
        ax.plot(self.wavelength_nm, self.index, label="refractive index")
        ax.set_xlabel("wavelength (nm)")
        ax.set_ylabel("refractive index")
        if self.emission.any():
            other = ax.twinx()
            other.fill_between(self.wavelength_nm, self.emission, alpha=0.3, color="C1")
            other.set_ylabel("emission (1/nm, relative)")
            other.set_ylim(bottom=0)
        ax.set_title(self.name)
        return ax

    def __repr__(self) -> str:
        light = f", {self.yield_per_keV:g} photons/keV" if self.yield_per_keV else ""
        return f"Medium({self.name!r}, index {self.index[len(self.index) // 2]:.4g}{light})"

    def _repr_html_(self) -> str:
        rows = [(f"{w:g}", f"{n:.4f}", f"{a:.4g}") for w, n, a in
                zip(self.wavelength_nm[::10], self.index[::10], self.absorption_length_mm[::10])]
        return html_table(self.name, ("wavelength (nm)", "index", "absorption length (mm)"), rows, "; ".join(self.sources))


class Goniometer:
    """Goniometer readings of one surface in a parallel beam, at each angle of incidence.

    ``incidence_deg`` (n,), ``reflectance``, ``transmittance``, ``absorptance`` (n, 2: with errors), ``slope_deg``
    (n, 2: mean visible slope; None for surfaces without facets), ``reflected_per_sr`` and ``transmitted_per_sr``
    (n, 180, 2: density in the plane of incidence per sr) over ``profile_deg`` (middles of bins of 1 deg, forward
    positive), ``index`` of the two media, ``warnings``.
    """

    def __init__(self, surface: str, entry: Dict[str, Any]) -> None:
        self.surface = surface
        self.incidence_deg = np.degrees(entry["incidence_rad"])
        self.reflectance: np.ndarray = entry["reflectance"]
        self.transmittance: np.ndarray = entry["transmittance"]
        self.absorptance: np.ndarray = entry["absorptance"]
        self.slope_deg = None if entry["slope_rad"] is None else np.degrees(entry["slope_rad"])
        self.profile_deg = np.arange(180) - 89.5
        self.reflected_per_sr = np.array([d["reflected_per_sr"] for d in entry["directions"]])
        self.transmitted_per_sr = np.array([d["transmitted_per_sr"] for d in entry["directions"]])
        self.directions: List[Dict[str, Any]] = entry["directions"]
        self.index: Tuple[float, float] = entry["index"]
        self.warnings: List[str] = entry["warnings"]

    def to_dataframe(self) -> Any:
        """A DataFrame with one row per angle; units in ``attrs["units"]``."""
        columns: Dict[str, Any] = {"incidence_deg": self.incidence_deg}
        for name in ("reflectance", "transmittance", "absorptance"):
            columns[name], columns[f"{name}_error"] = getattr(self, name).T
        return dataframe(columns, {name: "deg" if name == "incidence_deg" else "1" for name in columns})

    def to_xarray(self) -> Any:
        """A Dataset of the shares over ``incidence`` and of the profiles over ``incidence`` and ``angle``."""
        xarray = need("xarray", "to_xarray()")
        data: Dict[str, Any] = {}
        for name in ("reflectance", "transmittance", "absorptance"):
            values = getattr(self, name)
            data[name] = ("incidence", values[:, 0], {"units": "1"})
            data[f"{name}_error"] = ("incidence", values[:, 1], {"units": "1"})
        for name in ("reflected_per_sr", "transmitted_per_sr"):
            data[name] = (("incidence", "angle"), getattr(self, name)[:, :, 0], {"units": "1/sr"})
        return xarray.Dataset(data, {"incidence": ("incidence", self.incidence_deg, {"units": "deg"}),
                                     "angle": ("angle", self.profile_deg, {"units": "deg"})}, {"surface": self.surface})

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws the profile in the plane of incidence for a single angle, or the shares against incidence for
        several. Returns the axes."""
        ax = axes_for(ax)
        if len(self.incidence_deg) == 1:
            for name, values in (("reflected", self.reflected_per_sr[0]), ("transmitted", self.transmitted_per_sr[0])):
                if values[:, 0].any():
                    ax.stairs(values[:, 0], np.arange(181) - 90, label=name)
            ax.set_xlabel("angle in the plane of incidence (deg, forward positive)")
            ax.set_ylabel("light per solid angle (1/sr)")
            ax.set_title(f"{self.surface}, {self.incidence_deg[0]:g} deg")
        else:
            for name in ("reflectance", "transmittance", "absorptance"):
                values = getattr(self, name)
                if values[:, 0].any():
                    ax.errorbar(self.incidence_deg, values[:, 0], values[:, 1], fmt="o-", markersize=3, label=name)
            ax.set_xlabel("angle of incidence (deg)")
            ax.set_ylabel("share of the light")
            ax.set_title(self.surface)
        ax.legend()
        return ax

    def __repr__(self) -> str:
        return f"Goniometer({self.surface!r}, {len(self.incidence_deg)} angles)"

    def _repr_html_(self) -> str:
        rows = [(f"{a:g}", *(str(estimate(v[i])) for v in (self.reflectance, self.transmittance, self.absorptance)))
                for i, a in enumerate(self.incidence_deg)]
        return html_table(self.surface, ("incidence (deg)", "reflected", "transmitted", "absorbed"), rows)


def goniometer(surface: str, incidence_deg: Any, *, inside: str = "LSO", outside: str = "air",
               wavelength_nm: float = 420.0, side: str = "inside", rays: int = 100_000, seed: int = 1,
               half_width_deg: float = 5.0, definitions: str = "") -> Goniometer:
    """Goniometer reading of a surface of the material database in a parallel beam of unpolarised light
    (docs/surfaces.md).

    Parameters
    ----------
    surface, inside, outside : names; ``definitions`` is a text with further ones ([surfaces.NAME], ...)
    incidence_deg : angles from the mean normal, from 0 to below 90
    side : "inside" or "outside", of the incident light
    rays : at each angle
    half_width_deg : of the profile, out of the plane of incidence

    Raises InputError for unknown names (with the nearest), and numbers out of range.
    """
    angles = numbers(np.atleast_1d(incidence_deg), "incidence_deg", (-1,), "deg")
    one_of(side, "side", _SIDES)
    wavelength = number(wavelength_nm, "wavelength_nm", "nm", above=0.0)
    width = number(half_width_deg, "half_width_deg", "deg", above=0.0)
    return Goniometer(surface, _core.goniometer(
        text_of(surface, "surface"), text_of(inside, "inside"), text_of(outside, "outside"), wavelength,
        np.radians(angles).tolist(), side == "inside", whole(rays, "rays", least=1), whole(seed, "seed"),
        float(np.radians(width)), text_of(definitions, "definitions")))


class SurfaceTable:
    """A table of a surface: reflectance against incidence, from both sides, at each wavelength and azimuth.

    ``slices`` is a list of dictionaries: ``wavelength_nm`` (0: any), ``azimuth_rad``, ``index``, and for ``inside``
    and ``outside`` the arrays ``incidence_rad``, ``reflectance`` and ``absorptance`` (n, 2: with errors),
    ``mean_slope_rad``. ``provenance`` has its inputs.
    """

    def __init__(self, core: Any) -> None:
        self._core = core
        self.slices: List[Dict[str, Any]] = [core.slice(i) for i in range(core.slices())]
        self.provenance: Dict[str, Any] = core.provenance()

    @classmethod
    def read(cls, path: PathLike) -> "SurfaceTable":
        """The table of a file (HDF5). Raises InputError."""
        return cls(_core.read_table(path_text(path)))

    def write(self, path: PathLike) -> None:
        """Writes the table (HDF5), for ``model = "table"`` of a surface. Raises SystemFailure."""
        self._core.write(path_text(path))

    def reflectance(self, incidence_deg: Any, side: str = "inside", slice: int = 0) -> np.ndarray:
        """Reflectance at angles (deg), linear between nodes, of the shape of ``incidence_deg``; beyond the last
        node that of the last. Raises InputError for angles outside 0 to 90, another side, and a slice that does
        not exist."""
        shape = np.shape(incidence_deg)
        angles = numbers(np.ravel(incidence_deg), "incidence_deg", (-1,), "deg")
        wrong = np.flatnonzero((angles < 0) | (angles > 90))
        if len(wrong):
            raise InputError(f"incidence_deg has {angles[wrong[0]]:g}; expected 0 to 90", "give angles from the normal in deg")
        nodes = self._slice(slice)[one_of(side, "side", _SIDES)]
        return np.interp(np.radians(angles), nodes["incidence_rad"], nodes["reflectance"][:, 0]).reshape(shape)

    def _slice(self, number: int) -> Dict[str, Any]:
        return self.slices[index_of(number, "slice", len(self.slices))]

    def plot(self, ax: Optional[Any] = None, slice: int = 0) -> Any:
        """Draws the reflectance against incidence, from both sides. Returns the axes."""
        ax = axes_for(ax)
        for side in ("inside", "outside"):
            nodes = self._slice(slice)[side]
            ax.errorbar(np.degrees(nodes["incidence_rad"]), *nodes["reflectance"].T, fmt=".-", label=f"from {side}")
        ax.set_xlabel("angle of incidence (deg)")
        ax.set_ylabel("reflectance")
        ax.set_title(self.provenance["map"])
        ax.legend()
        return ax

    def __repr__(self) -> str:
        return f"SurfaceTable({self.provenance['map']!r}, {len(self.slices)} slices)"

    def _repr_html_(self) -> str:
        return html_table("Surface table", ("", ""), [(k, v) for k, v in self.provenance.items() if v])


class HeightMap:
    """Heights of a surface on a grid: ``heights_um`` (rows, columns; nan: missing; a read-only view), with
    ``pitch_um`` (x, y), ``periodic``, ``title`` and ``steps``, the record of its origin and processing.

    Parameters
    ----------
    heights_um : (rows, columns) numbers, um; nan for missing points
    pitch_um : distance of points, or (x, y), um
    periodic : the map is one period of a periodic surface
    """

    def __init__(self, heights_um: Any, pitch_um: Any, *, periodic: bool = False, title: str = "from Python") -> None:
        try:
            heights = np.asarray(heights_um, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise InputError(f"heights_um is not an array of numbers: {error}",
                             "give an array (rows, columns) in um") from error
        if heights.ndim != 2 or min(heights.shape) < 2:
            raise InputError(f"heights_um has the shape {heights.shape}; expected (rows, columns), 2 x 2 at least",
                             "give a two-dimensional array in um")
        if np.isinf(heights).any():
            raise InputError("heights_um has infinite heights", "write nan for missing points")
        pitch = numbers(np.atleast_1d(pitch_um), "pitch_um", (-1,), "um")
        if len(pitch) == 1:
            pitch = np.repeat(pitch, 2)
        if len(pitch) != 2:
            raise InputError(f"pitch_um has {len(pitch)} numbers; expected one, or (x, y)", "give distances in um")
        if (pitch <= 0).any():
            raise InputError(f"pitch_um is {pitch.tolist()}; expected above 0", "give the distance of points in um")
        self._core: Any = _core.map_from(heights, float(pitch[0]), float(pitch[1]),
                                        flag(periodic, "periodic"), text_of(title, "title"))

    @classmethod
    def _of(cls, core: Any) -> "HeightMap":
        made = cls.__new__(cls)
        made._core = core
        return made

    @classmethod
    def read(cls, path: PathLike, *, pitch_um: Optional[float] = None, height_unit_um: Optional[float] = None,
             channel: Optional[str] = None, periodic: bool = False) -> "HeightMap":
        """The map of a file of a microscope or profiler (docs/height_maps.md). Units are read, never guessed: raises
        InputError when neither the file nor the arguments state one."""
        def length(value: Optional[float], name: str) -> Optional[float]:
            return None if value is None else number(value, name, "um", above=0.0)
        return cls._of(_core.read_map(path_text(path), length(pitch_um, "pitch_um"),
                                      length(height_unit_um, "height_unit_um"),
                                      None if channel is None else text_of(channel, "channel"),
                                      flag(periodic, "periodic")))

    @classmethod
    def synthesize(cls, kind: str, *, seed: int = 1, points: int = 0, **lengths: float) -> "HeightMap":
        """A map of a recipe: "ground", "polished", "gaussian" (rms_height_um, correlation_length_um; also
        lay_length_um, lay_angle_rad) or "k_correlation" (rms_height_um, knee_length_um, exponent); pitch_um for any.
        Lengths in um (lay_length_um 0: no lay); ``points`` along an edge (0: the recipe's). Raises InputError for a length that is missing,
        unknown or out of range."""
        required = {"ground": (), "polished": (), "gaussian": ("rms_height_um", "correlation_length_um"),
                    "k_correlation": ("rms_height_um", "knee_length_um", "exponent")}
        if not isinstance(kind, str) or kind not in required:
            raise names_hint("kind of map", kind, list(required))
        known = (*required[kind], *(("lay_length_um", "lay_angle_rad") if kind == "gaussian" else ()), "pitch_um")
        for name in lengths:
            if name not in known:
                raise names_hint(f"length of a {kind} map", name, known)
        missing = [name for name in required[kind] if name not in lengths]
        if missing:
            raise InputError(f"a {kind} map needs " + " and ".join(missing), f"write {missing[0]}=1.0, for example")
        values = {name: number(value, name, "um" if name.endswith("_um") else "",
                               **({} if name == "lay_angle_rad" else {"least": 0.0} if name == "lay_length_um"
                                  else {"above": 0.0})) for name, value in lengths.items()}
        return cls._of(_core.synthesize_map(kind, values, whole(seed, "seed"),
                                            whole(points, "points", most=_MOST_POINTS)))

    @property
    def heights_um(self) -> np.ndarray:
        return self._core.heights()

    @property
    def pitch_um(self) -> Tuple[float, float]:
        return self._core.pitch_um()

    @property
    def periodic(self) -> bool:
        return self._core.periodic()

    @property
    def title(self) -> str:
        return self._core.title()

    @property
    def steps(self) -> List[str]:
        return self._core.steps()

    @property
    def statistics(self) -> Dict[str, Any]:
        """Heights (um) and slopes (ISO 25178-2): ``sa_um``, ``sq_um``, ``sz_um``, ``ssk``, ``sku``, ``sdq``, ``sdr``,
        ``mean_slope_rad``, ``rms_slope_rad``, ``slope_histogram`` (90 bins of 1 deg), ``missing``, ..."""
        return self._core.statistics()

    def prepared(self, *, level: Optional[int] = 1, gaussian_um: Optional[float] = None, median: Optional[int] = None,
                 outliers: Optional[float] = None, fill_missing: bool = False) -> "HeightMap":
        """A copy without outliers (beyond ``outliers`` robust standard deviations), with missing points filled,
        filtered by a median (radius in points) and a Gaussian (standard deviation, um), and with a polynomial
        of degree ``level`` subtracted (0: the mean; None: none). Raises InputError for numbers out of range."""
        return HeightMap._of(self._core.prepared(
            None if level is None else whole(level, "level", most=20),
            None if gaussian_um is None else number(gaussian_um, "gaussian_um", "um", above=0.0),
            None if median is None else whole(median, "median", least=1, most=1000),
            None if outliers is None else number(outliers, "outliers", above=0.0), flag(fill_missing, "fill_missing")))

    def visible_slope(self, incidence_deg: float = 0.0, rays: int = 20_000) -> Estimate:
        """Mean visible slope (deg): mean angle of the facets that light at an incidence angle hits first."""
        angle = float(np.radians(number(incidence_deg, "incidence_deg", "deg", least=0.0, below=90.0)))
        value, error = self._core.visible_slope(angle, whole(rays, "rays", least=1))
        return Estimate(float(np.degrees(value)), float(np.degrees(error)))

    def table(self, inside: float, outside: float = 1.0, *, rays: int = 2000, seed: int = 1, directional: bool = False,
              reciprocal: bool = False, progress: Progress = None) -> SurfaceTable:
        """The ``SurfaceTable`` of the map between media of these refractive indices, traced with ``rays`` for each
        angle of incidence and azimuth. Raises InputError; Cancelled."""
        index = [number(inside, "inside", above=0.0), number(outside, "outside", above=0.0)]
        return SurfaceTable(watched(progress, lambda call: _core.build_table(
            self._core, index[0], index[1], whole(rays, "rays", least=1), whole(seed, "seed"),
            flag(directional, "directional"), flag(reciprocal, "reciprocal"), call)))

    def write(self, path: PathLike) -> None:
        """Writes a Gwyddion simple field (.gsf). Raises SystemFailure."""
        self._core.write(path_text(path))

    def plot(self, ax: Optional[Any] = None) -> Any:
        """Draws the heights. Returns the axes."""
        ax = axes_for(ax)
        heights, (x, y) = self.heights_um, self.pitch_um
        image = ax.imshow(heights, origin="lower", extent=(0, x * heights.shape[1], 0, y * heights.shape[0]),
                          cmap="viridis", interpolation="nearest")
        ax.set_xlabel("x (um)")
        ax.set_ylabel("y (um)")
        ax.set_title(self.title)
        ax.figure.colorbar(image, ax=ax, label="height (um)")
        return ax

    def __repr__(self) -> str:
        rows, columns = self.heights_um.shape
        return f"HeightMap({self.title!r}, {columns} x {rows} points, Sq {self.statistics['sq_um']:.4g} um)"

    def _repr_html_(self) -> str:
        rows = [(k, f"{v:.6g}") for k, v in self.statistics.items() if not isinstance(v, np.ndarray)]
        return html_table(self.title, ("statistic", "value"), rows, "; ".join(self.steps))
