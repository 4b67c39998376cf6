"""Scenes: loaded from files, or built in code, and changed by the paths of their keys."""

from __future__ import annotations

import copy
import hashlib
import os
import re
import shutil
import tempfile
import weakref
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _toml
from ._checks import listed, numbers, one_of, path_of, text_of
from ._tools import Shown, axes_for, html_table
from .errors import InputError, SystemFailure

try:
    import tomllib as _reader
except ImportError:  # Python before 3.11
    import tomli as _reader  # type: ignore[no-redef]

PLANES = ("xy", "xz", "yz")
_BODIES = ("part", "array", "light_guide")

__all__ = ["Mesh", "Scene", "quantity"]

KeyPath = _toml.Path


def quantity(value: Any, unit: str) -> Any:
    """A quantity in the notation of scenes: ``quantity(2.5, "mm")`` is "2.5 mm"; of an array, a list of such
    texts.

    Numbers have all their digits. Raises InputError for numbers that are not finite, and for other types.
    """
    text_of(unit, "unit")
    array = np.asarray(value)
    if array.ndim:
        return [quantity(element, unit) for element in array]
    if array.dtype.kind not in "iuf":
        raise InputError(f"{value!r} is not a number", f'write quantity(2.5, "{unit}")')
    number = array.item()
    if not np.isfinite(number):
        raise InputError(f"{number} {unit} is not finite", "give a finite number")
    return f"{number!r} {unit}"


class Mesh(Shown):
    """A triangle mesh of a part, from arrays.

    Parameters
    ----------
    vertices : (n, 3) numbers, finite, in ``unit``
    triangles : (m, 3) indices of vertices from 0, counter-clockwise seen from outside
    unit : "mm", "cm", "um", ...: required, since a wrong default would scale the detector

    Raises InputError for other shapes, numbers that are not finite, and indices without a vertex; whether the
    mesh is closed is checked when the scene is built.
    """

    def __init__(self, vertices: Any, triangles: Any, unit: str) -> None:
        text_of(unit, "unit")
        self.vertices = numbers(vertices, "vertices", (-1, 3), unit)
        corners = numbers(triangles, "triangles", (-1, 3))
        if len(corners) == 0:
            raise InputError("the mesh has no triangles", "give one row of three indices per triangle")
        whole = corners == np.floor(corners)
        if not whole.all():
            row, column = np.argwhere(~whole)[0]
            raise InputError(f"triangles[{row}, {column}] is {corners[row, column]}; expected a whole number",
                             "give indices of vertices, from 0")
        outside = (corners < 0) | (corners >= len(self.vertices))
        if outside.any():
            row, column = np.argwhere(outside)[0]
            raise InputError(f"triangles[{row}, {column}] is {corners[row, column]:.0f}; there are "
                             f"{len(self.vertices)} vertices", "indices count from 0")
        self.triangles = np.ascontiguousarray(corners, dtype=np.int32)
        self.unit = unit

    def write(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes a binary PLY file with vertices in double precision. Raises SystemFailure."""
        header = ("ply\nformat binary_little_endian 1.0\n"
                  f"element vertex {len(self.vertices)}\n"
                  "property double x\nproperty double y\nproperty double z\n"
                  f"element face {len(self.triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
        faces = np.empty(len(self.triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
        faces["count"] = 3
        faces["corners"] = self.triangles
        _write(path_of(path), header.encode("ascii") + self.vertices.astype("<f8").tobytes() + faces.tobytes())

    def plot(self, ax: Optional[Any] = None, *, plane: str = "xz") -> Any:
        """Draws the edges between faces, projected onto a plane ("xy", "xz" or "yz"), in the mesh's unit.
        Returns the axes."""
        ax = axes_for(ax)
        draw_edges(ax, one_of(plane, "plane", PLANES), self.vertices, self.triangles, self.unit)
        return ax

    def _rows(self) -> Any:
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        return [("vertices", len(self.vertices)), ("triangles", len(self.triangles))] \
            + [(f"{axis} ({self.unit})", f"{low[k]:.6g} to {high[k]:.6g}") for k, axis in enumerate("xyz")]

    def _name(self) -> str:
        content = hashlib.sha256(self.vertices.tobytes() + self.triangles.tobytes()).hexdigest()
        return f"mesh_{content[:16]}.ply"

    def __repr__(self) -> str:
        return f"Mesh({len(self.vertices)} vertices, {len(self.triangles)} triangles, unit={self.unit!r})"


class Scene:
    """A scene: its keys as in a scene file (docs/scene_files.md), each of which can be read and set by its
    path.

    >>> scene = Scene.load("first.toml")
    >>> scene["part.crystal.surface"] = "lso_ground_30um"
    >>> scene["source.photons"] = 10_000

    Entries of lists are addressed by their name ("part.crystal.face.exit.surface") or number, elements of three
    by x, y and z. Values are as in the file: text with the unit ("2 mm", see ``quantity``), numbers,
    lists, dictionaries; a part's ``mesh`` may also be a ``Mesh``. Every key is checked when the scene is used,
    by the reader of scene files, so that messages have the line of ``text``. Paths that do not exist raise
    InputError.

    The dictionary itself is ``data``. ``part``, ``array`` and ``define`` add entries to it.
    """

    def __init__(self, title: str = "", ambient: str = "air", **keys: Any) -> None:
        self.data: Dict[str, Any] = {"title": title, "ambient": ambient, **keys}
        self._folder = Path.cwd()
        self._file: Optional[Path] = None
        self._original: Optional[Tuple[str, Dict[str, Any]]] = None
        self._meshes: Optional[Path] = None
        self._order: List[Any] = []  # bodies as they were added: one that touches another comes after it

    @classmethod
    def load(cls, path: Union[str, "os.PathLike[str]"]) -> "Scene":
        """The scene of a file. Raises InputError for a file that is missing or not TOML; its keys are checked
        when it is used."""
        file = path_of(path)
        try:
            text = file.read_text(encoding="utf-8")
        except OSError as error:
            raise InputError(f"{file} cannot be read: {error.strerror}", "check the path") from error
        except UnicodeDecodeError as error:
            raise InputError(f"{file} is not text", "give a scene file (TOML)") from error
        scene = cls.from_text(text, file.parent)
        scene._file = file
        return scene

    @classmethod
    def from_text(cls, text: str, folder: Union[str, "os.PathLike[str]", None] = None) -> "Scene":
        """The scene of a TOML text; paths in it are relative to ``folder`` (default: the working folder).
        Raises InputError for text that is not TOML."""
        scene = cls()
        text_of(text, "the text of a scene")
        if folder is not None:
            scene._folder = path_of(folder, "folder")
        try:
            scene.data = _reader.loads(text)
        except _reader.TOMLDecodeError as error:
            raise InputError(f"the text is not TOML: {error}", "see https://toml.io") from error
        scene._original = (text, copy.deepcopy(scene.data))
        remaining = {kind: iter(scene.data.get(kind, [])) for kind in _BODIES}
        headers = re.findall(r"^[ \t]*\[\[[ \t]*(\w+)[ \t]*\]\]", text, re.MULTILINE)
        scene._order = [entry for kind in headers if kind in remaining for entry in [next(remaining[kind], None)]
                        if entry is not None]
        return scene

    # Keys

    def __getitem__(self, path: KeyPath) -> Any:
        return _toml.get(self.data, path)

    def __setitem__(self, path: KeyPath, value: Any) -> None:
        _toml.put(self.data, path, value)

    def __delitem__(self, path: KeyPath) -> None:
        _toml.remove(self.data, path)

    def __contains__(self, path: KeyPath) -> bool:
        try:
            _toml.get(self.data, path)
        except InputError:
            return False
        return True

    def copy(self) -> "Scene":
        """An independent copy; meshes, which are immutable, are shared."""
        twin = Scene()
        twin.data, twin._order = copy.deepcopy((self.data, self._order), {id(m): m for m in self._all_meshes()})
        twin._folder, twin._file, twin._original = self._folder, self._file, self._original
        return twin

    def with_keys(self, changes: Mapping[str, Any]) -> "Scene":
        """A copy in which the keys at these paths have these values. Raises InputError as setting a key."""
        twin = self.copy()
        for path, value in changes.items():
            twin[path] = value
        return twin

    # Building

    def _add(self, table: str, name: str, keys: Dict[str, Any]) -> "Scene":
        text_of(name, "name")
        entries = self.data.setdefault(table, [])
        if any(entry.get("name") == name for entry in entries):
            raise InputError(f'there is a {table} "{name}" already', "give each a name of its own")
        entries.append({"name": name, **{k: v for k, v in keys.items() if v is not None}})
        self._order.append(entries[-1])
        return self

    def part(self, name: str, *, mesh: Union[Mesh, str, "os.PathLike[str]", None] = None,
             faces: Sequence[Mapping[str, Any]] = (), **keys: Any) -> "Scene":
        """Adds a [[part]]: its shape (``mesh`` or box, cylinder, prism, tapered, winston, sphere), medium, surface,
        sensor, place, ... and the rules of its faces. Returns the scene. Raises InputError for a name in use.

        >>> scene.part("crystal", box=["2 mm", "2 mm", "20 mm"], medium="LYSO", surface="polished")
        """
        rules = [_table(face, "a face") for face in listed(faces, "faces", "dictionaries")]
        return self._add("part", name, {"mesh": mesh, **keys, "face": rules or None})

    def array(self, name: str, *, count: Sequence[int], element: Mapping[str, Any], **keys: Any) -> "Scene":
        """Adds an [[array]] of ``count`` columns and rows of one ``element`` (docs/builders.md). Returns the scene."""
        return self._add("array", name, {"count": listed(count, "count", "two whole numbers"), **keys,
                                         "element": _table(element, "element")})

    def light_guide(self, name: str, **keys: Any) -> "Scene":
        """Adds a [[light_guide]] (docs/builders.md). Returns the scene."""
        return self._add("light_guide", name, keys)

    def define(self, kind: str, name: str, **keys: Any) -> "Scene":
        """Adds a medium, surface, sensor or reflector of the scene's own: ``define("surfaces", "wrapped",
        base="polished", gap="air", reflector="ESR")`` (docs/materials.md). Returns the scene. Raises InputError
        for another ``kind``."""
        kinds = ("media", "surfaces", "sensors", "reflectors")
        if kind not in kinds:
            raise InputError(f"{kind!r} is not a kind of definitions", "it is one of " + ", ".join(kinds))
        self.data.setdefault(kind, {})[text_of(name, "name")] = keys
        return self

    def tally(self, type: str, **keys: Any) -> "Scene":
        """Adds a [[tally]] (docs/tallies.md). Returns the scene."""
        self.data.setdefault("tally", []).append({"type": text_of(type, "type"), **keys})
        return self

    def sweep(self, key: str, values: Sequence[Any], label: Optional[str] = None) -> "Scene":
        """Adds a [[sweep]] over the values of a key. Returns the scene."""
        entry: Dict[str, Any] = {"key": text_of(key, "key"), "values": listed(values, "values", "values of the key")}
        self.data.setdefault("sweep", []).append(entry if label is None else {**entry, "label": label})
        return self

    # Text

    def _all_meshes(self) -> List[Mesh]:
        found: List[Mesh] = []
        for value in _nested(self.data):
            if isinstance(value, Mesh):
                found.append(value)
        return found

    def _unchanged(self) -> bool:
        return self._original is not None and not self._all_meshes() and self.data == self._original[1]

    def _text_with(self, folder: Optional[Path]) -> str:
        """The text, with the meshes in a folder: beside the text, or (None) with their full paths."""
        if self._unchanged():
            assert self._original is not None
            return self._original[0]
        if folder is None and self._all_meshes():
            if self._meshes is None:
                self._meshes = _temporary_folder(self)

        def special(value: Any, path: str) -> Any:
            if isinstance(value, Mesh):
                target = folder if folder is not None else self._meshes
                assert target is not None
                file = target / value._name()
                if not file.exists():
                    value.write(file)
                return file.name if folder is not None else str(file)
            return value

        bodies = self._bodies()
        data = {key: value for key, value in self.data.items() if key not in {kind for kind, _ in bodies}}
        return _toml.dump(data, special, [(kind, _with_unit(entry)) for kind, entry in bodies])

    def _bodies(self) -> List[Tuple[str, Any]]:
        """Parts, arrays and light guides, as (kind, entry), in the order in which they were added."""
        bodies = [(kind, entry) for kind in _BODIES if isinstance(self.data.get(kind), list)
                  for entry in self.data[kind]]
        place = {id(entry): i for i, entry in enumerate(self._order)}
        return sorted(bodies, key=lambda body: place.get(id(body[1]), len(place)))

    @property
    def text(self) -> str:
        """The scene as TOML: the text of the file while nothing is changed. Raises InputError for values that a
        scene cannot hold."""
        return self._text_with(None)

    @property
    def file(self) -> str:
        """The name of the scene in messages and results; paths are relative to its folder."""
        if self._file is not None:
            return str(self._file) if self._unchanged() else f"{self._file} (changed in Python)"
        return str(self._folder / "scene made in Python")

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the scene as a file, with the files of its meshes beside it, for the program ``scintray``.

        Relative paths in the scene are not changed, and must therefore be valid from the new folder. Raises
        SystemFailure for a file that cannot be written.
        """
        file = path_of(path)
        text = self._text_with(file.parent)
        _write(file, text.encode("utf-8"))

    # Use

    def simulation(self, **options: Any) -> Any:
        """A ``Simulation`` of a copy of this scene, with its options. Raises InputError with all mistakes."""
        from .simulation import Simulation
        return Simulation(self, **options)

    def run(self, *, progress: Any = None, output: Any = None, deposits: Any = None, photon_list: Any = None,
            **options: Any) -> Any:
        """Runs the scene: ``Simulation(scene, **options).run(...)``. Returns ``Results``; raises as there."""
        with self.simulation(**options) as simulation:
            return simulation.run(progress=progress, output=output, deposits=deposits, photon_list=photon_list)

    def check(self) -> List[str]:
        """Builds the scene and returns its warnings. Raises InputError with all mistakes of the scene."""
        with self.simulation() as simulation:
            return simulation.check()

    def plot(self, ax: Optional[Any] = None, plane: str = "xz") -> Any:
        """Draws the edges of the placed parts, projected onto a plane ("xy", "xz" or "yz"), mm."""
        with self.simulation() as simulation:
            return simulation.plot(ax, plane=plane)

    def _rows(self) -> List[Tuple[str, str, str, str]]:
        rows = []
        for _, entry in self._bodies():
            if not isinstance(entry, dict):
                continue
            body = {**entry, **entry.get("element", {})}
            shape = next((k for k in ("mesh", "box", "cylinder", "prism", "tapered", "winston", "sphere")
                          if k in body), "")
            count = " x ".join(map(str, entry["count"])) if "count" in entry else ""
            rows.append((f"{entry.get('name', '')} {count}".strip(), f"{shape} {_short(body.get(shape, ''))}",
                         str(body.get("medium", body.get("sensor", ""))), str(body.get("surface", ""))))
        return rows

    def __repr__(self) -> str:
        names = ", ".join(row[0] for row in self._rows())
        return f"Scene({self.data.get('title', '')!r}: {names or 'no parts'})"

    def _repr_html_(self) -> str:
        source = self.data.get("source", {})
        return html_table(str(self.data.get("title", "")) or "Scene", ("part", "shape", "medium or sensor", "surface"),
                          self._rows(), f"source: {source.get('type', 'none')}; ambient: {self.data.get('ambient', '')}")


def as_scene(scene: Any) -> Scene:
    """A scene, or that of the file of a path. Raises InputError for other types."""
    if isinstance(scene, (str, os.PathLike)):
        return Scene.load(scene)
    if not isinstance(scene, Scene):
        raise InputError(f"{scene!r} is not a scene", "give a Scene, or the path of a scene file")
    return scene


def _table(value: Any, name: str) -> Dict[str, Any]:
    try:
        return dict(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} is {value!r}; expected a dictionary", 'write {"key": value, ...}') from error


def _write(path: Path, content: bytes) -> None:
    try:
        path.write_bytes(content)
    except OSError as error:
        raise SystemFailure(f"{path} cannot be written: {error.strerror}; hint: check folder and permissions") from error


def _temporary_folder(owner: Any) -> Path:
    """A temporary folder that is removed with ``owner``."""
    folder = tempfile.mkdtemp(prefix="scintray-")
    weakref.finalize(owner, shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def _short(value: Any) -> str:
    text = " x ".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _nested(value: Any) -> Any:
    yield value
    for inner in value.values() if isinstance(value, dict) else value if isinstance(value, (list, tuple)) else ():
        yield from _nested(inner)


def _with_unit(entry: Any) -> Any:
    """The table of a part, with the unit of its mesh added where that is a ``Mesh``."""
    if not isinstance(entry, dict):
        return entry
    if isinstance(entry.get("mesh"), Mesh):
        entry = {**entry, "unit": entry["mesh"].unit}
    if isinstance(entry.get("element"), dict):
        entry = {**entry, "element": _with_unit(entry["element"])}
    return entry


def draw_edges(ax: Any, plane: str, vertices: np.ndarray, triangles: np.ndarray, unit: str = "mm", **style: Any) -> None:
    """Draws the edges between triangles that are not coplanar, projected onto a plane."""
    lines = vertices[_sharp_edges(vertices, triangles)][:, :, ["xyz".index(axis) for axis in plane]]
    flat = np.full((len(lines), 3, 2), np.nan)
    flat[:, :2] = lines
    ax.plot(flat[:, :, 0].ravel(), flat[:, :, 1].ravel(), linewidth=0.8, **style)
    ax.set_aspect("equal")
    ax.set_xlabel(f"{plane[0]} ({unit})")
    ax.set_ylabel(f"{plane[1]} ({unit})")


def _sharp_edges(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Edges (n, 2) between triangles that are not coplanar."""
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(triangles)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    unique, first, count = np.unique(edges, axis=0, return_index=True, return_counts=True)
    sharp = count != 2
    pairs = np.flatnonzero(count == 2)
    a, b = owner[first[pairs]], owner[first[pairs] + 1]
    sharp[pairs] = np.einsum("ij,ij->i", normals[a], normals[b]) < 0.9999
    return unique[sharp]
