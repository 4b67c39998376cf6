"""Bad input from Python: wrong shapes, units, numbers that are not finite, closed objects."""

import pickle

import numpy as np

import scintray
from support import BOX_TRIANGLES, BOX_VERTICES, SOURCE, Case, crystal, detector, main


class Scenes(Case):
    def test_a_mistake_has_its_place_its_line_and_a_hint(self):
        scene = crystal()
        scene['part.crystal.surfce'] = 'polished'
        error = self.refused(scene.run, 'surfce', 'surface')
        problem = error.problems[0]
        self.assertGreater(problem.line, 1)
        self.assertIn('surfce', problem.source)
        self.assertEqual(scene.text.splitlines()[problem.line - 1], problem.source)
        self.assertIn('made in Python', problem.file)
        self.assertTrue(problem.hint)
        self.assertIsInstance(error, ValueError)
        self.assertIsInstance(error, scintray.Error)

    def test_all_mistakes_come_at_once(self):
        scene = crystal()
        scene['part.crystal.box'] = ['2 mm', '2 kg', '10 mm']
        scene['run.seed'] = -1
        scene['source.wavelength'] = 420
        self.assertGreaterEqual(len(self.refused(scene.run, '2 kg', 'seed', 'wavelength').problems), 3)

    def test_a_changed_file_is_named(self):
        scene = scintray.Scene.load(SOURCE / 'scenes/quickstart.toml')
        scene['part.crystal.medium'] = 'LSP'
        self.refused(scene.check, 'quickstart.toml (changed in Python)', 'LSP', 'LSO')

    def test_values_that_a_scene_cannot_hold(self):
        for value, words in ((np.nan, 'not finite'), (np.inf, 'not finite'), (object(), 'object'), (None, 'NoneType'),
                             (3 + 4j, 'complex'), ([1.0, [np.nan]], 'not finite')):
            scene = crystal()
            scene['source.photons'] = value
            self.refused(scene.run, 'source.photons', words)
        self.refused(lambda: scintray.quantity(np.nan, 'mm'), 'not finite')
        self.refused(lambda: scintray.quantity('2', 'mm'), 'not a number')

    def test_paths_that_lead_nowhere(self):
        scene = crystal()
        self.refused(lambda: scene['part.cristal.surface'], 'cristal', 'crystal')
        self.refused(lambda: scene['sorce'], 'sorce', 'source')
        self.refused(lambda: scene['title.x'], 'has no key')
        self.refused(lambda: scene['part.7'], '7', 'count from 0')
        self.refused(lambda: scene['part..surface'], 'not the path')
        self.refused(lambda: scene.__delitem__('run.speed'), 'speed')
        self.assertNotIn('run.speed', scene)

    def test_files_that_are_no_scenes(self):
        self.refused(lambda: scintray.Scene.load(self.folder / 'none.toml'), 'none.toml')
        (self.folder / 'bytes.toml').write_bytes(b'\xff\xfe\x00')
        self.refused(lambda: scintray.Scene.load(self.folder / 'bytes.toml'), 'not text')
        self.refused(lambda: scintray.Scene.from_text('a = = 1'), 'not TOML')
        self.refused(lambda: scintray.open_results(self.folder / 'none.h5'), 'none.h5')
        (self.folder / 'text.h5').write_text('not HDF5')
        self.refused(lambda: scintray.open_results(self.folder / 'text.h5'), 'text.h5')

    def test_names_that_are_taken(self):
        self.refused(lambda: crystal().part('pmt', box=['1 mm', '1 mm', '1 mm']), 'pmt', 'already')
        self.refused(lambda: crystal().define('glass', 'x'), 'glass', 'media')

    def test_an_output_that_cannot_be_written(self):
        with self.assertRaises(scintray.Error):
            crystal(100).run(output=self.folder / 'no/such/folder/x.h5')
        (self.folder / 'mine.h5').write_text('precious')
        self.refused(lambda: crystal(100).run(output=self.folder / 'mine.h5'), 'mine.h5')
        self.assertEqual((self.folder / 'mine.h5').read_text(), 'precious')


class Meshes(Case):
    def test_meshes_of_wrong_shapes_and_numbers(self):
        mesh = scintray.Mesh
        self.refused(lambda: mesh(BOX_VERTICES[:, :2], BOX_TRIANGLES, unit='mm'), 'vertices', '(8, 2)', '(n, 3)')
        self.refused(lambda: mesh(BOX_VERTICES, BOX_TRIANGLES.ravel(), unit='mm'), 'triangles', '(36,)')
        self.refused(lambda: mesh(BOX_VERTICES, BOX_TRIANGLES + 0.5, unit='mm'), 'whole number')
        self.refused(lambda: mesh(BOX_VERTICES, BOX_TRIANGLES + 1, unit='mm'), 'there are 8 vertices')
        self.refused(lambda: mesh(BOX_VERTICES, BOX_TRIANGLES - 1, unit='mm'), 'count from 0')
        self.refused(lambda: mesh(BOX_VERTICES, np.zeros((0, 3)), unit='mm'), 'no triangles')
        wrong = BOX_VERTICES.copy()
        wrong[3, 1] = np.nan
        self.refused(lambda: mesh(wrong, BOX_TRIANGLES, unit='mm'), 'vertices[3, 1]', 'nan')
        self.refused(lambda: mesh('box', BOX_TRIANGLES, unit='mm'), 'not an array of numbers')
        with self.assertRaises(TypeError):
            mesh(BOX_VERTICES, BOX_TRIANGLES)

    def test_an_unknown_unit_and_an_open_mesh_are_found_when_the_scene_is_built(self):
        for mesh, words in ((scintray.Mesh(BOX_VERTICES, BOX_TRIANGLES, unit='furlong'), 'furlong'),
                            (scintray.Mesh(BOX_VERTICES, BOX_TRIANGLES[:-1], unit='mm'), 'crystal')):
            scene = crystal()
            del scene['part.crystal.box']
            scene['part.crystal.mesh'] = mesh
            self.refused(scene.check, words)


class Objects(Case):
    def test_closed_objects(self):
        simulation = crystal(100).simulation()
        results = simulation.run()
        simulation.close()
        with self.assertRaises(scintray.ClosedError):
            simulation.run()
        with self.assertRaises(scintray.ClosedError):
            simulation.points
        with crystal(100).run() as results:
            pass
        for work in (lambda: results.photons, lambda: results.events(), lambda: results[0]):
            with self.assertRaises(scintray.ClosedError):
                work()
        self.assertIn('closed', repr(simulation))

    def test_options_of_wrong_types(self):
        for options, words in (({'threads': 0}, 'threads'), ({'photons': 1.5}, 'photons'), ({'events': -3}, 'events'),
                               ({'seed': -1}, 'seed'), ({'seed': 2**64}, 'seed'), ({'threads': True}, 'threads')):
            self.refused(lambda options=options: crystal().simulation(**options), words)
        self.refused(lambda: crystal().run(events=5), 'events')
        self.refused(lambda: crystal().run(progress='yes'), 'progress')
        self.refused(lambda: scintray.Simulation(7), 'not a scene')
        self.refused(lambda: crystal().simulation().parts(3), 'no point 3')
        self.refused(lambda: crystal().simulation().parts(-1), 'whole number')
        self.refused(lambda: crystal().plot(plane='zz'), 'plane')

    def test_what_a_run_did_not_record(self):
        results = crystal(100).run()
        self.refused(lambda: results.photons, 'photon_list')
        self.refused(lambda: results.events(), 'no events')
        self.refused(lambda: results.analyze(), 'no events')
        self.refused(lambda: results[0].tally('spread'), 'spread')
        with self.assertRaises(IndexError):
            results[1]
        with self.assertRaises(IndexError):
            results.events(4)
        self.refused(lambda: detector(5).run().analyze(settings='[analysis]\nslicez = 3'), 'slicez', 'slices')

    def test_surfaces_and_maps_of_wrong_shapes_and_names(self):
        self.refused(lambda: scintray.Medium('LSP'), 'LSP', 'LSO')
        self.refused(lambda: scintray.Medium('LSO', [420, -1]), 'positive')
        self.refused(lambda: scintray.names('glues'), 'glues', 'media')
        self.refused(lambda: scintray.goniometer('polishd', 10), 'polishd', 'polished')
        self.refused(lambda: scintray.goniometer('polished', 95, rays=10), '95')
        self.refused(lambda: scintray.goniometer('polished', np.nan), 'incidence_deg[0]')
        self.refused(lambda: scintray.goniometer('polished', 10, side='up'), "'up'")
        self.refused(lambda: scintray.goniometer('polished', 10, rays=0), 'rays')
        self.refused(lambda: scintray.HeightMap(np.zeros(5), 0.1), '(5,)')
        self.refused(lambda: scintray.HeightMap(np.full((4, 4), np.inf), 0.1), 'infinite')
        self.refused(lambda: scintray.HeightMap(np.zeros((4, 4)), 0.0), 'pitch_um')
        self.refused(lambda: scintray.HeightMap(np.full((4, 4), np.nan), 1.0).table(1.8), '')
        self.refused(lambda: scintray.HeightMap.synthesize('sand'), 'sand')
        self.refused(lambda: scintray.HeightMap.synthesize('gaussian', rms_hight_um=1), 'rms_height_um')
        self.refused(lambda: scintray.HeightMap.read(self.folder / 'none.gwy'), 'none.gwy')
        self.refused(lambda: scintray.ResponseMap.build(crystal()), '')
        self.refused(lambda: scintray.ResponseMap.build(detector(), pitch_mm=-1), 'pitch_mm')
        self.refused(lambda: scintray.fit(crystal()), 'fit')
        self.refused(lambda: scintray.reweight('none.h5', 'LSO', [1], property='colour'), 'colour')

    def test_an_error_can_be_printed_and_its_problems_read(self):
        problem = scintray.Problem('a box of 0 mm', 'give a length', 'x.toml', 3, 7, source='box = 0')
        self.assertEqual(str(problem), 'x.toml:3:7: a box of 0 mm\n    box = 0\n  hint: give a length')
        again = pickle.loads(pickle.dumps(scintray.InputError([problem])))
        self.assertEqual(again.problems, [problem])


if __name__ == '__main__':
    main()
