"""Scenes that the tests of the Python module share."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import scintray

SOURCE = Path(os.environ.get('SCINTRAY_SOURCE', Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get('SCINTRAY', str(SOURCE / 'build/ci/bin/scintray'))


class Case(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix='scintray-test-')
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def refused(self, work, *words):
        """The InputError of some work, with these words."""
        with self.assertRaises(scintray.InputError) as caught:
            work()
        for word in words:
            self.assertIn(word, str(caught.exception))
        return caught.exception


def program(*arguments, folder=None):
    """Runs the program; returns what it printed."""
    # What was loaded into this interpreter (a sanitizer's runtime) is not for the program.
    environment = {key: value for key, value in os.environ.items() if key != 'LD_PRELOAD'}
    done = subprocess.run([PROGRAM, *map(str, arguments)], check=False, cwd=folder, text=True, env=environment,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0:
        raise AssertionError(f'{done.args} returned {done.returncode}: {done.stderr}')
    return done.stdout


def crystal(photons=2000, **keys):
    """A polished crystal on a photomultiplier, light from single photons."""
    scene = scintray.Scene('A crystal', **keys)
    scene.part('crystal', box=['2 mm', '2 mm', '10 mm'], medium='LSO', surface='polished',
               faces=[{'name': 'exit', 'select': {'normal': [0, 0, -1]}, 'surface': 'polished'}])
    scene.part('pmt', box=['2 mm', '2 mm', '1 mm'], sensor='R6231',
               place={'touch': 'crystal', 'side': '-z', 'gap': '0.1 mm', 'fill': 'optical_grease'})
    scene['source'] = {'type': 'photons', 'region': {'part': 'crystal'}, 'wavelength': '420 nm', 'photons': photons}
    scene['run'] = {'seed': 5}
    return scene


def detector(events=40):
    """A crystal with two ends read out, events of 511 keV."""
    scene = crystal()
    scene.part('far', box=['2 mm', '2 mm', '1 mm'], sensor='R6231',
               place={'touch': 'crystal', 'side': '+z', 'gap': '0.1 mm', 'fill': 'optical_grease'})
    scene['part.pmt.sensor'] = scene['part.far.sensor'] = 'S13360_6050VE'
    scene['source'] = {'type': 'gamma_events', 'events': events, 'region': {'part': 'crystal'}, 'energy': '50 keV'}
    scene['analysis'] = {'depth': {'from': ['0 mm', '0 mm', '0 mm'], 'along': [0, 0, 1]}}
    return scene


#: Corners and triangles of a box of 2 x 2 x 10 mm3, from z = 0 up.
BOX_VERTICES = np.array([[x, y, z] for z in (0.0, 10.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
BOX_TRIANGLES = np.array([[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
                          [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]])


def main():
    unittest.main(verbosity=1, argv=[sys.argv[0]])
