"""Every block of sh and of Python on all other pages: those of the pages that a user follows are run by pages_test.py,
those of docs/python.md by the tests of the Python module.

A page that says "your scene" gets the one below. Blocks with a program that is not ours (Slurm, parallel, git) are checked
by the shell's parser, the lines of scintray in them are run all the same; lines of tools/NAME name a script that is there."""

import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
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
           'exec scintray': 'scintray'}
# Lines that belong to other machines: launched by MPI, or long.
ELSEWHERE = {
    'mpirun -n 64 scintray run scanner.toml -o scanner.h5': 'tests/cli/mpi_test.cpp runs 1, 2 and 4 ranks',
    'scintray run scenes/roncali2013/light_output.toml --quick': 'tests/regression; a minute and more',
    'valgrind --tool=cachegrind --cache-sim=no --branch-sim=yes build/ci/bin/scintray run rough.toml -t 1 --photons $n':
        'a measurement; the scene is one of tools/benchmark',
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
        if line in ELSEWHERE or not re.search(r'\bscintray (run|merge|response|replay|view|report|check|goniometer|fit)\b', line):
            continue
        yield line


class Commands(unittest.TestCase):
    def test_every_block_of_other_pages_is_run_or_parsed(self):
        counted = {'sh': 0, 'python': 0, 'scintray': 0}
        for page in pages():
            with tempfile.TemporaryDirectory() as folder:
                for line, language, block in blocks((SOURCE / page).read_text()):
                    if language not in ('sh', 'python'):
                        continue
                    counted[language] += 1
                    with self.subTest(page=page, line=line):
                        if language == 'python':
                            self.run_python(block, Path(folder))
                        else:
                            counted['scintray'] += self.run_shell(block, Path(folder))
        self.assertGreaterEqual(counted['sh'], 10)
        self.assertGreaterEqual(counted['python'], 3)
        self.assertGreaterEqual(counted['scintray'], 8)

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
            if 'scanner.*.shard' in words:
                for old in folder.glob('scanner.*.shard'):
                    old.unlink()
                for shard in range(1, 4):
                    self.scintray(folder, 'run', 'scanner.toml', '--quiet', '--shard', f'{shard}/3')
                at = words.index('scanner.*.shard')
                words[at:at + 1] = sorted(path.name for path in folder.glob('scanner.*.shard'))
            self.assertEqual(words[0], 'scintray', line)
            for name in ('scanner.h5', 'scanner.html'):
                (folder / name).unlink(missing_ok=True)
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
