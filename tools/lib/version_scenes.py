"""The benchmark's scenes as files that other versions of the program read, version 0.1 (commit 819c164) among them.

That one has no key `curved`, which is left out, and knows facets only. A mesh that the benchmark makes is written beside
the scene."""

import dataclasses
import os
import subprocess
import sys
from pathlib import Path

SCENES = Path(__file__).resolve().parents[1] / "benchmark" / "scenes"


@dataclasses.dataclass
class Row:
    """A scene of the benchmark with the texts that take the place of others, and its size."""

    title: str
    file: str
    changes: list
    size: list
    divisions: int = 0  # of each edge of the crystal's box, as triangles of a mesh; 0: the box itself


def crystal(title, surface, photons, accelerator="auto", divisions=0, emission=False):
    changes = [('surface = "polished"            # set', f'surface = "{surface}"  # set'),
               ('accelerator = "auto"', f'accelerator = "{accelerator}"')]
    if emission:
        changes.append(('wavelength = "420 nm"', 'wavelength = "emission"'))
    if divisions:
        changes.append(('box = ["2 mm", "2 mm", "20 mm"]', 'mesh = "crystal.off"\nunit = "mm"'))
    return Row(title, "crystal.toml", changes, ["--photons", str(photons)], divisions)


def array(count, kind, surface, photons):
    return Row(f"array_{count}_{kind}", "array.toml",
               [("count = [1, 1]", f"count = [{count}, {count}]"), ('crystal[0,0]', f"crystal[{count // 2},{count // 2}]"),
                ('surface = "polished"            # set', f'surface = "{surface}"  # set')],
               ["--photons", str(photons)])


ROWS = [
    crystal("polished", "polished", 320_000),
    crystal("polished_embree", "polished", 160_000, "embree"),
    crystal("polished_3072", "polished", 80_000, "embree", 16),
    crystal("unified", "roncali2013_unified_rough", 800_000),
    crystal("table", "lso_ground_30um_420nm", 800_000),
    crystal("painted", "painted", 400_000),
    crystal("table_ptfe", "table_ptfe", 100_000),
    crystal("height_map", "ground_on_the_spot", 40_000),
    crystal("unified_spectrum", "roncali2013_unified_rough", 400_000, emission=True),
    crystal("table_spectrum", "lso_ground_30um", 400_000, emission=True),
    Row("tape", "tape.toml", [], ["--photons", "60000"]),
    array(1, "bare", "polished", 200_000),
    array(20, "bare", "polished", 100_000),
    array(40, "bare", "polished", 100_000),
    array(1, "wrapped", "polished_lambertian_097", 100_000),
    array(20, "wrapped", "polished_lambertian_097", 100_000),
    array(40, "wrapped", "polished_lambertian_097", 100_000),
    Row("block", "block.toml", [], ["--photons", "40000"]),
    Row("million_triangles", "ball.toml", [("subdivisions = 224", "subdivisions = 100")],
        ["--photons", "20000"]),
    Row("gamma_array", "gamma.toml", [], ["--events", "200"]),
]


def off_of_box(divisions, half=(1, 1, 10)):
    """A box about the origin as an OFF file, each face of divisions x divisions squares of two triangles."""
    numbers, triangles = {}, []

    def corner(axis, side, i, j):
        at = [0, 0, 0]
        at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3] = side * divisions, 2 * i - divisions, 2 * j - divisions
        return numbers.setdefault(tuple(at), len(numbers))

    for axis in range(3):
        for side in (-1, 1):
            for i in range(divisions):
                for j in range(divisions):
                    a, b, c, d = (corner(axis, side, i + u, j + v) for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)))
                    triangles += [(a, b, c), (a, c, d)] if side > 0 else [(a, c, b), (a, d, c)]
    points = [" ".join(str(x * h / divisions) for x, h in zip(at, half)) for at in numbers]
    faces = [f"3 {a} {b} {c}" for a, b, c in triangles]
    return "\n".join(["OFF", f"{len(points)} {len(faces)} 0", *points, *faces, ""])


def write(row, folder, for_other=False):
    """Writes the scene of a row, for another version where that is given; the path. Raises ValueError for a scene that
    has not the texts to be changed."""
    folder = Path(folder)
    text = (SCENES / row.file).read_text(encoding="utf-8")
    for old, new in row.changes:
        if old not in text:
            raise ValueError(f"{row.file} has no {old!r}")
        text = text.replace(old, new)
    if for_other:
        text = text.replace('curved = "facets"\n', "")
    if row.divisions:
        (folder / "crystal.off").write_text(off_of_box(row.divisions), encoding="utf-8")
    path = folder / (("other_" if for_other else "") + row.title + ".toml")
    path.write_text(text, encoding="utf-8")
    return path


class Refused(Exception):
    """The message of a program on a scene that it does not run."""


@dataclasses.dataclass
class Measured:
    """What a run on one thread took."""

    segments: int
    seconds: float  # of tracing alone
    peak_MB: float  # the most resident memory of the whole run, building and results included
    process_s: float  # processor time of that


# A process counts the memory of the one that it was forked from, so that a small one starts the program.
PEAK_OF = """
import os, sys
nowhere = (os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)
process = os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ, file_actions=[nowhere])
_, status, usage = os.wait4(process, 0)
print(usage.ru_maxrss, usage.ru_utime + usage.ru_stime)
sys.exit(1 if status else 0)
"""


def run(program, tree, scene, options, folder):
    """What a run on one thread took.

    program  the command, as a list of words; tree: the repository whose materials it takes, empty for its own
    options  words after the others, as the number of photons or events
    """
    import h5py
    import numpy
    output = Path(folder) / "out.h5"
    output.unlink(missing_ok=True)
    environment = {**os.environ, "SCINTRAY_DATA": str(tree)} if tree else None
    words = ["run", str(scene), "-o", str(output), "--threads", "1", "--no-report", "--quiet", *options]
    done = subprocess.run([sys.executable, "-IS", "-c", PEAK_OF, *program, *words],
                          capture_output=True, text=True, env=environment, check=False)
    if done.returncode != 0:
        raise Refused(" ".join(done.stderr.split())[:160])
    peak_kiB, process_s = map(float, done.stdout.split())
    with h5py.File(output) as file:
        points = file["points"].values()
        return Measured(sum(int(numpy.ravel(point["segments"])[0]) for point in points),
                        sum(float(numpy.ravel(point["wall_seconds"])[0]) for point in points), peak_kiB * 1024 / 1e6,
                        process_s)
