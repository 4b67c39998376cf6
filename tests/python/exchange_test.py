"""Photon lists in as arrays, and ROOT trees through a stand-in for uproot, which Debian 12 does not have.

The stand-in has the few members of uproot that are used: open and recreate as context managers, keys, arrays. The true
uproot is tested where it is installed; elsewhere that test is skipped.
"""

import contextlib
import sys
import types

import numpy as np

import scintray
from support import Case, detector, main


def list_scene(**source):
    scene = detector()
    scene['source'] = {'type': 'photon_list', 'arrays': True, **source}
    scene['run.photon_list'] = True
    return scene


def some_photons(rows, seed):
    random = np.random.default_rng(seed)
    direction = random.normal(size=(rows, 3))
    return (np.sort(random.integers(0, 10, rows)), random.uniform([-0.9, -0.9, 0.1], [0.9, 0.9, 9.9], (rows, 3)),
            direction, random.uniform(400, 440, rows), random.uniform(0.0, 5.0, rows))


class Tree:
    def __init__(self, columns):
        self.columns = columns

    def keys(self):
        return list(self.columns)

    def arrays(self, names, library):
        assert library == 'np'
        return {name: np.asarray(self.columns[name]) for name in names}


class StandIn(types.ModuleType):
    """uproot with files in memory."""

    def __init__(self, files):
        super().__init__('uproot')
        self.files = files

    @contextlib.contextmanager
    def open(self, path):
        yield {f'{name};1': tree for name, tree in self.files[path].items()} | self.files[path]

    @contextlib.contextmanager
    def recreate(self, path):
        self.files[path] = {}
        yield self.files[path]


class Exchange(Case):
    def tearDown(self):
        sys.modules.pop('uproot', None)

    def test_photons_in_memory_are_those_of_a_file(self):
        event, position, direction, wavelength, time = some_photons(2000, 1)
        columns = np.column_stack([event, position, direction, wavelength, time])
        np.savetxt(self.folder / 'list.csv', columns, delimiter=',', comments='', fmt='%.17g',
                   header='event,x,y,z,direction_x,direction_y,direction_z,wavelength,time')
        named = np.zeros(len(event), dtype=[(name, 'f8') for name in
                                            ('event', 'x', 'y', 'z', 'direction_x', 'direction_y', 'direction_z',
                                             'wavelength', 'time')])
        for name, column in zip(named.dtype.names, columns.T):
            named[name] = column
        np.save(self.folder / 'list.npy', named)
        np.savez(self.folder / 'list.npz', **{name: named[name] for name in named.dtype.names})
        memory = list_scene().run(photon_list=scintray.PhotonList(position, direction, wavelength, event=event,
                                                                  time=time))
        self.assertEqual(memory.events().emitted.sum(), 2000)
        self.assertGreater(memory.events().detected.sum(), 100)
        for name in ('list.csv', 'list.npy', 'list.npz'):
            scene = list_scene()
            scene['source'] = {'type': 'photon_list', 'file': str(self.folder / name), 'length_unit': 'mm',
                               'wavelength_unit': 'nm', 'time_unit': 'ns'}
            np.testing.assert_array_equal(scene.run().photons, memory.photons)

    def test_photons_that_are_wrong_are_refused(self):
        photons = scintray.PhotonList([[0, 0, 1.0]], [[0, 0, 1.0]], energy=[3.0])
        self.assertAlmostEqual(photons.columns['wavelength'][0], 1239.8419843320026 / 3.0)
        self.refused(lambda: list_scene().run(photon_list=photons), 'event')
        self.assertEqual(list_scene(photons_per_event=1).run(photon_list=photons).events().emitted.tolist(), [1])
        self.refused(lambda: detector().run(photon_list=photons), 'takes no photons')
        self.refused(lambda: scintray.PhotonList([[0, 0, 1.0]], [[0, 0, 1.0]]), 'wavelength or an energy')
        self.refused(lambda: scintray.PhotonList([[0, 0, 1.0]], [0, 0, 1.0], [420]), 'direction')
        self.refused(lambda: list_scene(photons_per_event=1).run(
            photon_list=scintray.PhotonList([[0, 0, 1.0]], [[0, 0, 0.0]], [420])), 'direction is zero')

    def test_trees_of_both_versions_of_gate_become_deposits(self):
        runs, events = [0, 0, 1], [4, 4, 4]
        gate9 = {'runID': runs, 'eventID': events, 'posX': [0.1, 0.2, 0.3], 'posY': [0, 0, 0.0], 'posZ': [1, 2, 3.0],
                 'edep': [0.1, 0.2, 0.3], 'time': [1e-9, 2e-9, 5e-9], 'PDGEncoding': [11, 11, 22]}
        gate10 = {'EventID': events, 'PostPosition_X': [0.1, 0.2, 0.3], 'PostPosition_Y': [0, 0, 0.0],
                  'PostPosition_Z': [1, 2, 3.0], 'TotalEnergyDeposit': [0.1, 0.2, 0.3], 'GlobalTime': [1, 2, 5.0]}
        sys.modules['uproot'] = StandIn({'a.root': {'Hits': Tree(gate9)}, 'b.root': {'Hits': Tree(gate10)}})
        old, new = scintray.read_root_hits('a.root'), scintray.read_root_hits('b.root')
        self.assertEqual(old.event.tolist(), [0, 0, 1])  # the runs are kept apart
        self.assertEqual(new.event.tolist(), [4, 4, 4])
        for deposits in (old, new):
            np.testing.assert_allclose(deposits.energy_keV, [100, 200, 300])
            np.testing.assert_allclose(deposits.time_ns, [1, 2, 5])
            np.testing.assert_allclose(deposits.position_mm[:, 2], [1, 2, 3])
        own = scintray.read_root_hits('a.root', columns={'event': 'eventID', 'x': 'posX', 'y': 'posY', 'z': 'posZ',
                                                         'energy': 'edep', 'particle': 'PDGEncoding'},
                                      length_unit='cm')
        self.assertEqual(own.steps['particle'].tolist(), [11, 11, 22])
        np.testing.assert_allclose(own.position_mm[:, 2], [10, 20, 30])
        self.refused(lambda: scintray.read_root_hits('a.root', 'Hit'), "did you mean 'Hits'")
        self.refused(lambda: scintray.read_root_hits('a.root', columns={'event': 'eventID'}), 'no branch for x')
        self.refused(lambda: scintray.read_root_hits('a.root', columns={
            'event': 'eventID', 'x': 'pX', 'y': 'posY', 'z': 'posZ', 'energy': 'edep'}), "no branch 'pX'")
        sys.modules['uproot'].files['c.root'] = {'Hits': Tree({'a': [1]})}
        self.refused(lambda: scintray.read_root_hits('c.root'), 'neither GATE 9')

    def test_phase_spaces_and_ntuples_become_photon_lists(self):
        gate9 = {'RunID': [0, 0, 1, 1], 'EventID': [4, 4, 4, 4], 'X': [0.1, 0.2, 0.3, 9], 'Y': [0, 0, 0.0, 9],
                 'Z': [1, 2, 3.0, 9], 'dX': [0, 0, 1.0, 0], 'dY': [0, 1.0, 0, 0], 'dZ': [1.0, 0, 0, 1],
                 'Ekine': [3e-6, 3e-6, 2.5e-6, 0.5], 'Time': [1, 2, 5.0, 9],
                 'ParticleName': ['opticalphoton', 'opticalphoton', 'opticalphoton', 'gamma']}
        gate10 = {'EventID': [4, 4], 'KineticEnergy': [3e-6, 2e-6], 'PreGlobalTime': [1.0, 2.0]}
        for axis, position, direction in (('X', [1, 2.0], [0, 1.0]), ('Y', [0, 0.5], [0, 0.0]), ('Z', [3, 3.0], [1.0, 0])):
            gate10['PrePosition_' + axis], gate10['PreDirection_' + axis] = position, direction
        geant4 = {'px': [1.0], 'py': [2.0], 'pz': [3.0], 'ux': [0.0], 'uy': [0.0], 'uz': [1.0], 'lambda': [0.42],
                  'ax': [1.0], 'ay': [0.0], 'az': [0.0]}
        sys.modules['uproot'] = StandIn({'a.root': {'PhaseSpace': Tree(gate9)}, 'b.root': {'PhaseSpace': Tree(gate10)},
                                         'c.root': {'ntuple': Tree(geant4)}})
        old, new = scintray.read_root_photons('a.root'), scintray.read_root_photons('b.root')
        self.assertEqual(len(old), 3)  # the gamma is left out
        self.assertEqual(old.columns['event'].tolist(), [0, 0, 1])  # the runs are kept apart
        np.testing.assert_allclose(old.columns['wavelength'], 1239.8419843320026 / np.array([3, 3, 2.5]))
        np.testing.assert_allclose(old.columns['time'], [1, 2, 5])
        np.testing.assert_allclose(old.columns['direction_y'], [0, 1, 0])
        np.testing.assert_allclose(new.position_mm, [[1, 0, 3], [2, 0.5, 3]])
        names = {'x': 'px', 'y': 'py', 'z': 'pz', 'dx': 'ux', 'dy': 'uy', 'dz': 'uz', 'wavelength': 'lambda',
                 'ex': 'ax', 'ey': 'ay', 'ez': 'az'}
        own = scintray.read_root_photons('c.root', 'ntuple', columns=names, length_unit='cm', wavelength_unit='um')
        np.testing.assert_allclose(own.position_mm, [[10, 20, 30]])
        np.testing.assert_allclose(own.columns['wavelength'], [420])
        np.testing.assert_allclose(own.columns['polarisation_x'], [1])
        self.assertNotIn('event', own.columns)
        self.refused(lambda: scintray.read_root_photons('c.root', 'ntuple'), 'neither GATE 9', '"dx"')
        self.refused(lambda: scintray.read_root_photons('c.root', 'ntuples'), "did you mean 'ntuple'")
        self.refused(lambda: scintray.read_root_photons('c.root', 'ntuple', columns={'x': 'px'}), 'no branch for y')
        del names['ez']
        self.refused(lambda: scintray.read_root_photons('c.root', 'ntuple', columns=names), 'one or two of ex')
        gate9['ParticleName'] = ['gamma'] * 4
        self.refused(lambda: scintray.read_root_photons('a.root'), "'opticalphoton'")

    def test_the_true_uproot_writes_and_reads_trees(self):
        try:
            import uproot
        except ImportError:
            self.skipTest('skipped: uproot is not installed (pip install uproot)')
        path = str(self.folder / 'true.root')
        columns = {'EventID': np.array([0, 0, 1]), 'KineticEnergy': np.array([3e-6, 3e-6, 2e-6]),
                   'TotalEnergyDeposit': np.array([0.1, 0.2, 0.3])}
        for axis in 'XYZ':
            columns['PostPosition_' + axis] = columns['PrePosition_' + axis] = np.array([0.1, 0.2, 0.3])
            columns['PreDirection_' + axis] = np.array([0.0, 0.0, 1.0]) + (axis == 'Z')
        with uproot.recreate(path) as file:
            file['Hits'] = columns
        self.assertEqual(scintray.read_root_hits(path).event.tolist(), [0, 0, 1])
        self.assertEqual(len(scintray.read_root_photons(path, 'Hits')), 3)
        _, position, direction, wavelength, _ = some_photons(500, 2)
        results = list_scene(photons_per_event=100).run(
            photon_list=scintray.PhotonList(position, direction, wavelength))
        count = scintray.write_root_photons(results, str(self.folder / 'out.root'))
        with uproot.open(str(self.folder / 'out.root')) as file:
            self.assertEqual(file['photons'].num_entries, count)

    def test_detected_photons_become_a_tree(self):
        _, position, direction, wavelength, _ = some_photons(500, 2)
        results = list_scene(photons_per_event=100).run(
            photon_list=scintray.PhotonList(position, direction, wavelength))
        sys.modules['uproot'] = StandIn({})
        count = scintray.write_root_photons(results, 'out.root')
        tree = sys.modules['uproot'].files['out.root']['photons']
        self.assertEqual(count, len(tree['time_ns']))
        self.assertGreater(count, 0)
        self.assertTrue(all(np.asarray(column).ndim == 1 for column in tree.values()))

    def test_without_uproot_the_error_names_it(self):
        sys.modules['uproot'] = None
        with self.assertRaisesRegex(scintray.MissingPackage, 'pip install uproot'):
            scintray.read_root_hits('a.root')


if __name__ == '__main__':
    main()
