"""Deposits in as arrays, detected photons out as arrays."""

import numpy as np

import scintray
from support import Case, detector, main


def hits_scene():
    scene = detector()
    scene['source'] = {'type': 'hits', 'arrays': True}
    scene['run.photon_list'] = True
    return scene


def some_hits(events, seed):
    """A few deposits an event, in random order of rows within the crystal."""
    random = np.random.default_rng(seed)
    number = np.sort(random.integers(0, events, 4 * events))
    position = random.uniform([-0.9, -0.9, 0.1], [0.9, 0.9, 9.9], (4 * events, 3))
    return number, position, random.uniform(1.0, 20.0, 4 * events), random.uniform(0.0, 1.0, 4 * events)


class Arrays(Case):
    def test_hits_in_memory_give_the_light_of_the_same_hits_in_a_file(self):
        event, position, energy, time = some_hits(20, 1)
        columns = np.column_stack([event, position / 10, energy / 1000, time * 1000])
        np.savetxt(self.folder / 'hits.csv', columns, delimiter=',', header='event,x,y,z,energy,time', comments='',
                   fmt='%.17g')
        scene = hits_scene()
        scene['source'] = {'type': 'hits', 'file': str(self.folder / 'hits.csv'), 'length_unit': 'cm',
                           'energy_unit': 'MeV', 'time_unit': 'ps'}
        file = scene.run()
        memory = hits_scene().run(deposits=scintray.Deposits(event, position / 10, energy / 1000, time * 1000,
                                                             length_unit='cm', energy_unit='MeV', time_unit='ps'))
        a, b = file.events(), memory.events()
        self.assertEqual(len(a), len(np.unique(event)))
        np.testing.assert_allclose(a.energy_keV, b.energy_keV, rtol=1e-6)
        np.testing.assert_allclose(b.energy_keV, np.bincount(event, energy)[np.unique(event)], rtol=1e-6)
        # Light is drawn from the energy: unit factors may differ in their last bit, and so may a few events.
        self.assertGreater(np.mean(a.emitted == b.emitted), 0.9)
        photons = memory.photons
        self.assertEqual(photons.dtype.names[:4], ('point', 'event', 'photon', 'part'))
        self.assertEqual(len(photons), b.detected.sum())
        np.testing.assert_array_equal(np.bincount(photons['event'].astype(int), minlength=len(b)), b.detected)
        self.assertEqual({memory.parts[i] for i in np.unique(photons['part'])}, {'pmt', 'far'})
        np.testing.assert_allclose(np.linalg.norm(photons['direction'], axis=1), 1.0, rtol=1e-5)

    def test_steps_bring_their_displacement_and_their_numbers_of_photons(self):
        event, position, energy, time = (column[:2] for column in some_hits(10, 3))
        deposits = scintray.Deposits([0, 1], position, energy, time, displacement=[[0, 0, 0.01], [0.01, 0, 0]],
                                     charge=[-1, 1], scintillation_photons=[300, 500], decay=[10, 20])
        np.testing.assert_array_equal(hits_scene().run(deposits=deposits).events().emitted, [300, 500])
        self.refused(lambda: scintray.Deposits([0], [[0, 0, 1]], [10], gamma=[2]), 'is not a column of steps')
        self.refused(lambda: hits_scene().run(deposits=scintray.Deposits([0], [[0, 0, 1]], [10], beta=[0.9])),
                     'neither a charge nor a particle')

    def test_batches_through_one_simulation_are_those_of_simulations_of_their_own(self):
        with hits_scene().simulation() as simulation:
            for seed in (1, 2):
                deposits = scintray.Deposits(*some_hits(10, seed))
                together, alone = simulation.run(deposits=deposits), hits_scene().run(deposits=deposits)
                np.testing.assert_array_equal(together.events().detected, alone.events().detected)
                self.assertTrue((together.photons == alone.photons).all())

    def test_arrays_are_views_that_outlive_the_results(self):
        results = hits_scene().run(deposits=scintray.Deposits(*some_hits(10, 1)))
        photons, again, light = results.photons, results.photons, results.events().channel_detected
        self.assertTrue(np.shares_memory(photons, again))
        self.assertFalse(photons.flags.owndata)
        self.assertFalse(photons.flags.writeable)
        total, times = light.sum(), photons['time_ns'].copy()
        results.close()
        del results, again
        hits_scene().run(deposits=scintray.Deposits(*some_hits(10, 2)))
        self.assertEqual(light.sum(), total)
        np.testing.assert_array_equal(photons['time_ns'], times)


class Refused(Case):
    def test_deposits_of_wrong_shapes_units_and_numbers(self):
        event, position, energy, time = some_hits(5, 1)
        make = scintray.Deposits
        self.refused(lambda: make(event, position[:, :2], energy), 'position', '(20, 2)', '(20, 3)')
        self.refused(lambda: make(event, position, energy[:-1]), 'energy', '(19,)', '(20,)')
        self.refused(lambda: make(event, position, energy, length_unit='inch'), "'inch'", 'mm')
        self.refused(lambda: make(event, position, energy, energy_unit='J'), "'J'", 'keV')
        self.refused(lambda: make(event, position, np.where(np.arange(20) == 7, np.nan, energy)), 'energy[7]', 'nan')
        self.refused(lambda: make(event, position, -energy), 'energy[0]', 'negative')
        self.refused(lambda: make(event + 0.5, position, energy), 'event[0]', 'whole number')
        self.refused(lambda: make([], np.zeros((0, 3)), []), 'no deposits')
        self.refused(lambda: make(['a'], [[0, 0, 0]], [1]), 'event', 'numbers')

    def test_a_scene_that_takes_no_hits_or_gets_none(self):
        deposits = scintray.Deposits(*some_hits(5, 1))
        self.refused(lambda: detector().run(deposits=deposits), 'takes no hits', 'arrays = true')
        self.refused(lambda: hits_scene().run(), 'did not set them', 'run(deposits=...)')
        self.refused(lambda: hits_scene().run(deposits=[1, 2]), 'Deposits(')

    def test_hits_outside_every_part_are_counted(self):
        far = scintray.Deposits([0, 0], [[0, 0, 5], [90, 0, 0]], [10, 20])
        results = hits_scene().run(deposits=far)
        self.assertIn('1 of 2 hits lie outside', results.notes[0])
        self.assertEqual(results.events().non_scintillating_keV.tolist(), [20.0])
        nowhere = scintray.Deposits([0], [[90, 0, 0]], [10])
        self.refused(lambda: hits_scene().run(deposits=nowhere), 'none of the 1 hits of the calling program')


if __name__ == '__main__':
    main()
