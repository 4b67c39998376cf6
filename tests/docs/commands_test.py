"""Every block of sh and of Python on all other pages: those of the pages that a user follows are run by pages_test.py,
those of docs/python.md by the tests of the Python module.

Every line of scintray is run, with whatever subcommand, but for those in ELSEWHERE, each with its reason. A page that says
"your scene" gets the one below, and other files that a page supposes are in GIVEN. Blocks of TOML whose first line is
"# NAME.toml" are written as that file. Blocks with a program that is not ours (Slurm, parallel, git) are checked by the
shell's parser, the lines of scintray in them are run all the same; lines of tools/NAME name a script that is there."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

from pages_test import PAGES, PROGRAM, SOURCE, blocks, few

SCENE = '''title = "A crystal on a sensor"
ambient = "air"
contacts_default = "bonded"
[[part]]
name = "crystal"
box = { low = ["-1 mm", "-1 mm", "0 mm"], high = ["1 mm", "1 mm", "4 mm"] }
medium = "LSO"
surface = "wrapped"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "polished"
[[part]]
name = "sipm"
box = ["2 mm", "2 mm", "0.3 mm"]
place = { touch = "crystal", side = "-z", gap = "0.1 mm", fill = "optical_grease" }
sensor = "my_sipm"
[surfaces.wrapped]
base = "polished"
gap = "air"
reflector = "ESR"
[sensors.my_sipm]
base = "S13360_6050VE"
transit_time = { fwhm = "150 ps" }
single_electron = { charge_spread = "3 %", rise = "0.5 ns", decay = "20 ns" }
microcells = { pitch = "0.05 mm", recovery = "20 ns", crosstalk = "3 %" }
[source]
type = "gamma_events"
events = 6
region = { part = "crystal" }
energy = "10 keV"
[readout]
sampling = "1 GHz"
before = "50 ns"
threshold = 3.0
window = "300 ns"
pulses = true
[run]
photon_list = true
photon_history = true
'''
# Where a page has other names and numbers than fit a test: what stands for them.
NUMBERS = {'17/400': '1/3', '"$SLURM_ARRAY_TASK_ID/400"': '2/3', '{}/400': '3/3', '"$SLURM_CPUS_PER_TASK"': '1',
           '::: $(seq 400)': '', 'build/release/bin/scintray': 'scintray', 'parallel scintray': 'scintray',
           'exec scintray': 'scintray',
           '"$1/400"': '1/3', '"part.$1/$1.shard"': 'part.shard',
           # Fits of one small field, tables of few rays, a run of few photons.
           '"0.45 um" --seeds 5': '"0.45 um" --seeds 1 --points 256', '--seeds 5': '--seeds 1', 'table stack lso': 'table stack --rays 100 lso',
           'run wrapped.toml': 'run wrapped.toml --photons 20000',
           # A list of a gigabyte and more.
           '--photons 1001000000': '--photons 1001',
           # Maps of half a minute each, and their time.
           'time scintray': 'scintray', '--photons 12000': '--photons 20', '--channel-photons 60000': '--channel-photons 200',
           'module_map.h5 --shard': 'module_map.h5 --photons 20 --shard'}
# Lines that belong to other machines: launched by MPI, or long.
ELSEWHERE = {
    'mpirun -n 64 scintray run scanner.toml -o scanner.h5': 'tests/cli/mpi_test.cpp runs 1, 2 and 4 ranks',
    'scintray run scenes/roncali2013/light_output.toml --quick': 'tests/regression; a minute and more',
    'scintray import detector.step -o detector.toml':
        'a build without Open CASCADE refuses STEP files; tests/mesh/step_test.cpp reads some, tests/cli imports other bodies',
    'scintray run polished.toml -t 1 --photons $n -o $n.h5 --no-report': 'a measurement of ten million photons',
}
# Shards that a page merges, and what makes them.
SHARDS = {'scanner.*.shard': 'run scanner.toml --quiet',
          'module_map.*.shard': 'response build module.toml -o module_map.h5 --photons 20'}
GROUND = 'table stack --rays 100 lso_ground_30um --inside LSO --outside air --wavelength "420 nm" -o ground.h5'
CUBES = ''.join(f'o cube{i}\n' + ''.join(f'v {x + 3 * i} {y} {z}\n' for z in (0, 2) for x, y in ((0, 0), (2, 0), (2, 2), (0, 2))) +
                ''.join('f ' + ' '.join(str(8 * i + n) for n in face) + '\n' for face in
                        ((1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8))) for i in (0, 1))
GATE_MATERIALS = '''[Elements]
Oxygen:   S= O  ; Z=  8. ; A=  16.00 g/mole
Silicon:  S= Si ; Z= 14. ; A=  28.09 g/mole
Yttrium:  S= Y  ; Z= 39. ; A=  88.91 g/mole
Lutetium: S= Lu ; Z= 71. ; A= 174.97 g/mole
[Materials]
''' + ''.join(f'''{name}: d={density}; n={len(parts.split())}
''' + ''.join(f'    +el: name={part.split("=")[0]} ; n={part.split("=")[1]}\n' for part in parts.split())
                 for name, density, parts in (
    ('Air', '1.29 mg/cm3', 'Oxygen=1'), ('LYSO', '7.1 g/cm3', 'Lutetium=9 Yttrium=1 Silicon=5 Oxygen=25'),
    ('Grease', '1 g/cm3', 'Silicon=1 Oxygen=1'), ('Glass', '2.5 g/cm3', 'Silicon=1 Oxygen=2'), ('Silicon', '2.33 g/cm3', 'Silicon=1')))
CRYSTAL_IN_AIR = '''title = "A crystal with a rough surface"
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "4 mm"]
medium = "LSO"
surface = "WaterSurface"
[surfaces.WaterSurface]
model = "unified"
unified = { sigma_alpha = "10 deg", definition = "solid_angle", facets = "projected_area", lobe = 1.0 }
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 1000
'''
# What a page supposes to be there: files with their content, files of the repository, what commands of scintray write, with
# the names that other programs give.
GIVEN = {
    'docs/analysis.md': {'files': {'other.toml': SCENE}},
    'docs/exchange.md': {'run': [GROUND, GROUND.replace('30um', '30um_ptfe_air').replace('ground.h5', 'wrapped.h5')], 'files': {
        'surfaces/README': '', 'GroundTeflon.z': zlib.compress(b'0.5\n' * (91 * 45 * 37))}},
    'docs/importing.md': {'files': {'detector.obj': CUBES, 'GateMaterials.db': GATE_MATERIALS, 'detector.toml': CRYSTAL_IN_AIR},
                          'copied': {'main.mac': 'docs/examples/gate/lyso_array.mac',
                                     'Materials.xml': 'docs/examples/gate/Materials.xml',
                                     'Surfaces.xml': 'docs/examples/gate/Surfaces.xml'},
                          'run': ['export detector.toml -o detector.gdml'],
                          'renamed': {'detector.gdml': {'"air"': '"Air"'}}},
    'docs/readout.md': {'files': {'other.toml': SCENE}},
    'docs/results.md': {'run': [f'run scene.toml --no-view --seed {seed} -o {name}.h5' for seed, name in
                                enumerate(('quickstart', 'events', 'reference', 'changed', 'other'))]},
    'docs/scaling.md': {'files': {'module.toml': SCENE}},
    'docs/reweighting.md': {'files': {'scene.toml': SCENE.replace('ESR', 'PTFE')}},
}
# What stands before a block that goes on within a file: other absorption coefficients and reflectances.
PYTHON_BEFORE = {'weight = np.exp': '''import h5py
import numpy as np
with h5py.File("result.h5") as file:
    h = file["histories"]
    mu = np.full(h["absorption_depth"].shape[1], 0.01)
    R = np.full(h["reflections"].shape[1], 0.9)
'''}


def pages():
    """README and the pages of docs whose blocks no other test runs."""
    run_elsewhere = {*PAGES, 'docs/python.md'}
    names = ['README.md', 'CONTRIBUTING.md', *(str(p.relative_to(SOURCE)) for p in sorted(SOURCE.glob('docs/*.md')))]
    return [name for name in names if name not in run_elsewhere and name != 'docs/validation.in.md']


def scintray_lines(block):
    """The commands of scintray of a block, without their comments."""
    for line in block.replace('\\\n', ' ').splitlines():
        line = re.sub(r'\s+#.*$', '', line).strip()
        line = re.sub(r'^sbatch .*--wrap "(.*)"$', r'\1', line)
        for theirs, ours in NUMBERS.items():
            line = line.replace(theirs, ours)
        if line not in ELSEWHERE and re.search(r'(^|[/\s])scintray [a-z]+\b', line):
            yield line


class Commands(unittest.TestCase):
    def test_every_block_of_other_pages_is_run_or_parsed(self):
        counted = {'sh': 0, 'python': 0, 'scintray': 0}
        for page in pages():
            with tempfile.TemporaryDirectory() as folder:
                self.provide(page, Path(folder))
                for line, language, block in blocks((SOURCE / page).read_text()):
                    name = re.match(r'# (\S+\.toml)\n', block) if language == 'toml' else None
                    if name:
                        (Path(folder) / name.group(1)).write_text(block)
                    if language not in ('sh', 'python'):
                        continue
                    counted[language] += 1
                    with self.subTest(page=page, line=line):
                        self.write_given(page, Path(folder))
                        if language == 'python':
                            self.run_python(block, Path(folder))
                        else:
                            counted['scintray'] += self.run_shell(block, Path(folder))
        self.assertGreaterEqual(counted['sh'], 10)
        self.assertGreaterEqual(counted['python'], 3)
        self.assertGreaterEqual(counted['scintray'], 35)

    def test_every_command_stands_in_a_block_of_sh(self):
        for page in [*pages(), *PAGES]:
            text = re.sub(r'^```.*?^```$', '', (SOURCE / page).read_text(), flags=re.MULTILINE | re.DOTALL)
            self.assertEqual(re.findall(r'^ {4,}(?:\$ )?scintray [a-z].*', text, re.MULTILINE), [], page)

    def test_lines_of_others_are_those_of_the_pages(self):
        text = ''.join((SOURCE / page).read_text() for page in pages())
        for line in ELSEWHERE:
            self.assertIn(line, text)

    def test_lengths_of_the_same_array_here_and_in_gate_are_those_of_the_page(self):
        examples = SOURCE / 'docs/examples'

        def lines(text, comment='#'):
            text = re.sub(r'<!--.*?-->', '', text, flags=re.DOTALL)
            return sum(1 for line in text.splitlines() if line.strip() and not line.strip().startswith(comment))
        notebook = (examples / 'lyso_array.py').read_text()
        scene = next(cell for cell in notebook.split('# %%') if 'scene = scintray.Scene' in cell)
        counted = {'here: the scene in Python': lines(scene),
                   'here: with the run, the analysis and the plots': lines(notebook)}
        for name in ('lyso_array.mac', 'Materials.xml', 'Surfaces.xml'):
            counted[f'GATE: `{name}`'] = lines((examples / 'gate' / name).read_text())
        page = (SOURCE / 'docs/howto/geant4_gate.md').read_text()
        for what, count in counted.items():
            self.assertIn(f'| {what} | {count} |', page)

    def scintray(self, folder, *arguments):
        run = subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True,
                             env={**os.environ, 'SCINTRAY_DATA': str(SOURCE)})
        self.assertEqual(run.returncode, 0, f'{arguments}: {run.stdout}{run.stderr}')

    def provide(self, page, folder):
        """What a page supposes to be there."""
        self.write_given(page, folder)
        commands = GIVEN.get(page, {}).get('run', [])
        if commands:
            self.prepare(folder)
        for command in commands:
            self.scintray(folder, *shlex.split(command))
        for name, words in GIVEN.get(page, {}).get('renamed', {}).items():
            text = (folder / name).read_text()
            for ours, theirs in words.items():
                text = text.replace(ours, theirs)
            (folder / name).write_text(text)

    def write_given(self, page, folder):
        given = GIVEN.get(page, {})
        for name, content in given.get('files', {}).items():
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        for name, original in given.get('copied', {}).items():
            shutil.copy(SOURCE / original, folder / name)

    def prepare(self, folder):
        """The scene and its results; shards but for those that a page makes."""
        for name in ('scene.toml', 'scanner.toml'):
            if not (folder / name).exists():
                (folder / name).write_text(SCENE)
        if not (folder / 'result.h5').exists():
            self.scintray(folder, 'run', 'scene.toml', '-o', 'result.h5', '--no-view')

    def run_shell(self, block, folder):
        parsed = subprocess.run(['bash', '-n'], input=block, capture_output=True, text=True)
        self.assertEqual(parsed.returncode, 0, parsed.stderr)
        for tool in re.findall(r'^\(?(tools/\w+)', block, re.MULTILINE):
            self.assertTrue(os.access(SOURCE / tool, os.X_OK), tool)
        for preset in re.findall(r'--preset (\w+)', block):
            self.assertIn(f'"name": "{preset}"', (SOURCE / 'CMakePresets.json').read_text())
        count = 0
        for line in scintray_lines(block):
            self.prepare(folder)
            words = shlex.split(line)
            if words[0] == 'python3':
                continue
            count += 1
            for pattern, command in SHARDS.items():
                if pattern not in words:
                    continue
                for old in folder.glob(pattern):
                    old.unlink()
                for shard in range(1, 4):
                    self.scintray(folder, *shlex.split(command), '--shard', f'{shard}/3')
                at = words.index(pattern)
                words[at:at + 1] = sorted(path.name for path in folder.glob(pattern))
            self.assertEqual(words[0], 'scintray', line)
            for name in ('scanner.h5', 'scanner.html'):
                (folder / name).unlink(missing_ok=True)
            if words[1] == 'import':  # which replaces no scene
                (folder / words[words.index('-o') + 1]).unlink(missing_ok=True)
            self.scintray(folder, *few(words[1:]))
        return count

    def run_python(self, block, folder):
        self.prepare(folder)
        before = next((text for begin, text in PYTHON_BEFORE.items() if block.startswith(begin)), '')
        if before:  # within the file that it reads
            block = before + ''.join('    ' + line + '\n' for line in block.splitlines())
        run = subprocess.run([sys.executable, '-c', block, 'result.h5'], cwd=folder, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)


if __name__ == '__main__':
    unittest.main()
