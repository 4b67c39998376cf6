"""Scenes from files and in code, runs, and their agreement with the program to the last bit."""

import os
import signal
import threading
import time

import h5py
import numpy as np

import scintray
from support import BOX_TRIANGLES, BOX_VERTICES, SOURCE, Case, crystal, detector, main, program

#: What two runs of one scene do not share: names of files, times.
OWN = {'scene', 'wall_seconds'}


def datasets(path):
    """All datasets of a results file, by name."""
    found = {}
    with h5py.File(path) as file:
        def visit(name, item):
            if isinstance(item, h5py.Dataset) and name.rsplit('/', 1)[-1] not in OWN:
                found[name] = item[()]
        file.visititems(visit)
    return found


class Bits(Case):
    def same_files(self, a, b):
        first, second = datasets(a), datasets(b)
        self.assertEqual(sorted(first), sorted(second))
        self.assertGreater(len(first), 20)
        for name, values in first.items():
            self.assertEqual(np.asarray(values).tobytes() if values.dtype != object else values.tolist(),
                             np.asarray(second[name]).tobytes() if values.dtype != object else second[name].tolist(),
                             name)

    def test_photons_of_a_shipped_scene_are_those_of_the_program(self):
        path = SOURCE / 'scenes/quickstart.toml'
        program('run', path, '--photons', 3000, '--threads', 1, '--no-report', '-q', '-o', self.folder / 'program.h5')
        scene = scintray.Scene.load(path)
        scene.run(photons=3000, output=self.folder / 'python.h5')
        self.same_files(self.folder / 'program.h5', self.folder / 'python.h5')
        in_memory = scene.run(photons=3000, threads=2)
        written = datasets(self.folder / 'program.h5')
        self.assertEqual(len(in_memory), 15)
        for i, point in enumerate(in_memory):
            group = f'points/{i:04d}'
            np.testing.assert_array_equal(point.fate_count, written[f'{group}/fate_count'])
            np.testing.assert_array_equal(point.fate_fraction[:, 1], written[f'{group}/fate_error'])
            self.assertEqual(list(point.parameters.values()), [v.decode() for v in written[f'{group}/parameters']])

    def test_events_and_lists_of_a_scene_in_code_are_those_of_the_program(self):
        scene = detector(12)
        scene['run.photon_list'] = True
        scene['readout'] = {'sampling': '1 GHz', 'before': '20 ns', 'window': '200 ns', 'threshold': 2.0, 'shaping': {'order': 1, 'time_constant': '5 ns'},
                            'pulses': True, 'photon_order': [1, 2, 5]}
        scene.tally('count', name='times', at='detected',
                    axes=[{'variable': 'time', 'from': '0 ns', 'to': '200 ns', 'bins': 40}])
        scene.save(self.folder / 'scene.toml')
        program('run', 'scene.toml', '--no-report', '-q', '-o', 'program.h5', folder=self.folder)
        scene.run(output=self.folder / 'python.h5')
        self.same_files(self.folder / 'program.h5', self.folder / 'python.h5')

        memory, file = scene.run(), scintray.open_results(self.folder / 'program.h5')
        written = datasets(self.folder / 'program.h5')
        self.assertGreater(len(memory.photons), 1000)
        for results in (memory, file):
            for name in ('event', 'photon', 'time_ns', 'wavelength_nm', 'path_mm', 'interactions'):
                np.testing.assert_array_equal(results.photons[name], written[f'photons/{name}'], name)
            tally = results[0].tally('times')
            self.assertEqual(tally.sum.tolist(), written['points/0000/tallies/0000/sum'].tolist())
        a, b = memory.events(), file.events()
        self.assertEqual(a.waveform.shape, (12, 2, 200))
        self.assertEqual(a.order_ns.shape, (12, 2, 3))
        for name in ('event', 'energy_keV', 'position_mm', 'part', 'emitted', 'detected', 'channel_detected',
                     'first_ns', 'charge', 'amplitude', 'time_ns', 'order_ns', 'waveform'):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name), name)
        self.assertEqual(a.channels['name'], b.channels['name'])

    def test_a_numpy_mesh_is_the_mesh_of_its_file(self):
        scene = crystal()
        del scene['part.crystal.box']
        scene['part.crystal.mesh'] = scintray.Mesh(BOX_VERTICES / 10.0, BOX_TRIANGLES, unit='cm')
        scene.save(self.folder / 'scene.toml')
        self.assertEqual(len(list(self.folder.glob('*.ply'))), 1)
        program('run', 'scene.toml', '--no-report', '-q', '-o', 'program.h5', folder=self.folder)
        scene.run(output=self.folder / 'python.h5')
        self.same_files(self.folder / 'program.h5', self.folder / 'python.h5')
        # A box of the same size has the same volume, though not the same triangles.
        box, mesh = crystal(20000).run()[0].detected, scene.run(photons=20000)[0].detected
        self.assertLess(box.sigmas_from(mesh), 5.0)
        part = scene.simulation().parts()[0]
        self.assertAlmostEqual(part['vertices'][:, 2].max(), 10.0)
        self.assertEqual(part['name'], 'crystal')


class Memory(Case):
    def test_results_are_released(self):
        scene = detector(100)
        scene['source.energy'] = '5 keV'
        scene['readout'] = {'sampling': '10 GHz', 'before': '20 ns', 'window': '400 ns', 'threshold': 2.0, 'pulses': True,
                            'shaping': {'order': 1, 'time_constant': '5 ns'}}

        def resident():
            with open('/proc/self/statm') as file:
                return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE')

        def run(times):
            for _ in range(times):
                size = scene.run().events().waveform.nbytes
            return size
        run(5)
        before = resident()
        size = run(40)
        self.assertGreater(size, 3e6)
        # Forty runs that were kept would take 40 times the size.
        self.assertLess(resident() - before, 8 * size)


class Keys(Case):
    def test_keys_are_read_and_set_by_their_paths(self):
        scene = scintray.Scene.load(SOURCE / 'scenes/quickstart.toml')
        original = scene.text
        self.assertEqual(original, (SOURCE / 'scenes/quickstart.toml').read_text())
        self.assertEqual(scene['part.crystal.surface'], 'polished')
        self.assertEqual(scene['part.crystal.face.exit.surface'], 'polished')
        scene['part.crystal.face.exit.surface'] = 'lso_ground_30um'
        scene['source.photons'] = np.int64(500)
        scene['run.max_interactions'] = 1000
        del scene['sweep']
        self.assertNotIn('sweep', scene)
        again = scintray.Scene.from_text(scene.text, SOURCE / 'scenes')
        self.assertEqual(again.data, {**scene.data, 'source': {**scene['source'], 'photons': 500}})
        self.assertEqual(scene.run()[0].photons, 500)
        position = scintray.Scene(source={'position': ['1 mm', '2 mm', '3 mm']})
        position['source.position.z'] = '4 mm'
        self.assertEqual(position['source.position'], ['1 mm', '2 mm', '4 mm'])
        self.assertEqual(scene.with_keys({'run.seed': 9})['run.seed'], 9)
        self.assertEqual(scene['run.seed'], 1)

    def test_parts_of_all_kinds_keep_their_order(self):
        # An array that touches a part, which touches an array: the file's order is the one that can be read.
        scene = scintray.Scene.load(SOURCE / 'scenes/block_detector.toml')
        before = [part['name'] for part in scene.simulation().parts()]
        scene['source.photons'] = 1000
        self.assertNotEqual(scene.text, (SOURCE / 'scenes/block_detector.toml').read_text())
        self.assertEqual([part['name'] for part in scene.copy().simulation().parts()], before)

    def test_quantities_keep_all_digits(self):
        self.assertEqual(scintray.quantity(0.1 + 0.2, 'mm'), '0.30000000000000004 mm')
        self.assertEqual(scintray.quantity(np.array([1, 2.5]), 'mm'), ['1.0 mm', '2.5 mm'])

    def test_a_sweep_in_code_has_a_point_each(self):
        scene = crystal(500).sweep('part.crystal.surface', ['polished', 'lso_ground_30um'], label='surface')
        results = scene.run()
        self.assertEqual([p.parameters for p in results], [{'surface': 'polished'}, {'surface': 'lso_ground_30um'}])
        self.assertGreater(results[0].detected.value, results[1].detected.value)
        self.assertEqual(scene.simulation().points, 2)
        self.assertEqual(scene.simulation().parameters(1), {'surface': 'lso_ground_30um'})


class Control(Case):
    def test_progress_comes_in_the_calling_thread_and_reaches_the_end(self):
        calls, threads = [], set()

        def progress(done, of, thing):
            calls.append((done, of, thing))
            threads.add(threading.get_ident())
        crystal(400_000).run(progress=progress)
        self.assertEqual(threads, {threading.get_ident()})
        self.assertEqual(calls[-1], (400_000, 400_000, 'photons'))
        self.assertEqual([c[0] for c in calls], sorted(c[0] for c in calls))

    def test_a_false_progress_stops_and_keeps_the_photons(self):
        results = crystal(2_000_000_000).run(progress=lambda done, of, thing: done < 1000)
        self.assertFalse(results.complete)
        self.assertIn('stopped', results.partial_reason)
        self.assertGreater(results[0].photons, 0)
        self.assertEqual(results[0].fate_count.sum(), results[0].photons_traced)

    def test_an_error_of_progress_ends_the_run(self):
        def progress(done, of, thing):
            raise KeyError('from the callback')
        with self.assertRaises(KeyError) as caught:
            crystal(2_000_000_000).run(progress=progress)
        self.assertIn('from the callback', str(caught.exception))

    def test_ctrl_c_cancels_and_keeps_the_photons(self):
        timer = threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(scintray.Cancelled) as caught:
            crystal(2_000_000_000).run()
        self.assertIsInstance(caught.exception, KeyboardInterrupt)
        self.assertFalse(caught.exception.results.complete)
        self.assertGreater(caught.exception.results[0].photons, 0)

    def test_other_threads_run_while_photons_are_traced(self):
        ticks = []
        running = threading.Event()

        def count():
            running.set()
            while running.is_set():
                ticks.append(1)
                time.sleep(0.001)
        thread = threading.Thread(target=count)
        thread.start()
        running.wait()
        before = len(ticks)
        crystal(1_000_000).run(threads=1)
        during = len(ticks) - before
        running.clear()
        thread.join()
        self.assertGreater(during, 20)

    def test_one_simulation_runs_once_at_a_time(self):
        simulation = crystal(2_000_000_000).simulation()
        inside = []

        def progress(done, of, thing):
            try:
                simulation.run()
            except scintray.InputError as error:
                inside.append(str(error))
            return False
        simulation.run(progress=progress)
        self.assertIn('another thread', inside[0])
        # It can be run again afterwards.
        self.assertFalse(simulation.run(progress=lambda *_: False).complete)


if __name__ == '__main__':
    main()
