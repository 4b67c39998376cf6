"""What a calling program's functions do wrong: exceptions, wrong arguments, objects closed meanwhile; nothing is kept."""

import gc
import resource
import weakref

import numpy as np

import scintray
from support import BOX_TRIANGLES, BOX_VERTICES, Case, crystal, detector, main

ENDLESS = 2_000_000_000


def raising(error):
    def progress(done, of, thing):
        raise error
    return progress


class Callbacks(Case):
    def test_every_function_that_reports_progress_raises_what_its_callback_raised(self):
        flat = scintray.HeightMap(np.zeros((16, 16)), 1.0)
        fitted = crystal(2000)
        for work in (lambda progress: crystal(ENDLESS).run(progress=progress),
                     lambda progress: flat.table(1.82, rays=200_000, progress=progress),
                     lambda progress: scintray.ResponseMap.build(detector(), pitch_mm=1.0, photons_per_cell=1_000_000,
                                                                 progress=progress)):
            for error in (ValueError('mine'), scintray.InputError('mine'), SystemExit('mine'), GeneratorExit('mine')):
                with self.subTest(error=type(error).__name__), self.assertRaises(type(error)) as caught:
                    work(raising(error))
                self.assertIs(caught.exception, error)
        self.assertEqual(fitted.run().complete, True)

    def test_a_callback_of_other_arguments_is_the_error_of_python(self):
        with self.assertRaisesRegex(TypeError, 'argument'):
            crystal(ENDLESS).run(progress=lambda done: True)
        self.refused(lambda: crystal().run(progress=3), 'progress is 3')

    def test_an_error_of_a_callback_leaves_the_simulation_usable(self):
        simulation = crystal(300_000).simulation()
        with self.assertRaises(ZeroDivisionError):
            simulation.run(progress=lambda *_: 1 / 0)
        whole = simulation.run()
        self.assertTrue(whole.complete)
        np.testing.assert_array_equal(whole[0].fate_count, crystal(300_000).run()[0].fate_count)

    def test_a_simulation_closed_by_its_own_callback_finishes_and_is_closed(self):
        simulation = crystal(400_000).simulation()
        results = simulation.run(progress=lambda *_: simulation.close())
        self.assertTrue(results.complete)
        with self.assertRaises(scintray.ClosedError):
            simulation.run()

    def test_results_closed_by_a_callback_do_not_harm_the_run(self):
        held = crystal(1000).run()
        results = crystal(400_000).run(progress=lambda *_: held.close())
        self.assertTrue(results.complete)
        with self.assertRaises(scintray.ClosedError):
            held.photons

    def test_an_error_of_a_callback_is_released_with_its_objects(self):
        class Mine(Exception):
            pass
        error = Mine('once')
        alive = weakref.ref(error)
        try:
            crystal(ENDLESS).run(progress=raising(error))
        except Mine:
            pass
        del error
        gc.collect()
        self.assertIsNone(alive())


class Refusals(Case):
    def test_arrays_that_are_not_plain(self):
        mesh, deposits = scintray.Mesh, scintray.Deposits
        self.refused(lambda: mesh(BOX_VERTICES.astype(object) + 1j, BOX_TRIANGLES, unit='mm'), 'vertices')
        self.refused(lambda: mesh(BOX_VERTICES, BOX_TRIANGLES + 2.0**40, unit='mm'), 'triangles')
        self.refused(lambda: mesh([[0, 0, 0], [1, 0]], BOX_TRIANGLES, unit='mm'), 'vertices')
        self.refused(lambda: deposits([0], [[0, 0, 'x']], [1]), 'position')
        self.refused(lambda: deposits([[0]], [[0, 0, 0]], [1]), 'event')
        self.refused(lambda: deposits([0], [[0, 0, 0]], [1], [np.inf]), 'time[0]')
        self.refused(lambda: deposits([0], [[0, 0, 0]], [1], displacement=[[0, 0]]), 'displacement')

    def test_strided_swapped_and_read_only_arrays_are_taken_as_they_are(self):
        plain = scintray.Deposits([0, 1], [[0, 0, 1], [0, 0, 2]], [10, 20])
        wide = np.zeros((4, 6))
        wide[::2, ::2] = [[0, 0, 1], [0, 0, 2]]
        energy = np.array([10, 20], dtype='>f8')
        energy.flags.writeable = False
        for position in (wide[::2, ::2], np.asfortranarray([[0.0, 0, 1], [0, 0, 2]]), np.float32([[0, 0, 1], [0, 0, 2]])):
            made = scintray.Deposits(np.array([0, 1], dtype='i2'), position, energy)
            np.testing.assert_array_equal(made.position_mm, plain.position_mm)
            np.testing.assert_array_equal(made.energy_keV, plain.energy_keV)

    def test_refused_calls_keep_no_memory(self):
        wrong = crystal()
        wrong['part.crystal.surfce'] = 'polished'
        positions = np.zeros((50_000, 3))
        positions[-1, 2] = np.nan

        def refuse(times):
            for _ in range(times):
                for work in (wrong.check, lambda: scintray.Deposits(np.arange(50_000), positions, np.ones(50_000)),
                             lambda: crystal(ENDLESS).run(progress=raising(ValueError()))):
                    with self.assertRaises(ValueError):
                        work()
            gc.collect()
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        before = refuse(15)
        self.assertLess(refuse(30) - before, 30.0, 'MB; 30 calls with arrays of 1.2 MB')


if __name__ == '__main__':
    main()
