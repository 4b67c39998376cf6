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

    def test_arguments_of_wrong_kinds_are_named(self):
        flat = scintray.HeightMap(np.zeros((8, 8)), 1.0)
        table = flat.table(1.8, rays=20)
        results = detector(5).run()
        synthesize, goniometer = scintray.HeightMap.synthesize, scintray.goniometer
        cases = (
            (lambda: flat.visible_slope(95), 'incidence_deg is 95'),
            (lambda: flat.visible_slope(0, rays='many'), "rays is 'many'"),
            (lambda: flat.table(1.8, seed='a'), "seed is 'a'"),
            (lambda: flat.table(0.0), 'inside is 0'),
            (lambda: flat.table(1.8, directional='no'), 'directional', 'True or False'),
            (lambda: flat.prepared(level=-1), 'level is -1'),
            (lambda: flat.prepared(gaussian_um=np.nan), 'gaussian_um is nan'),
            (lambda: flat.write(7), 'path is 7'),
            (lambda: table.reflectance(np.nan), 'not finite'),
            (lambda: table.reflectance(91), 'incidence_deg has 91'),
            (lambda: table.reflectance(10, side='up'), "side is 'up'"),
            (lambda: table.reflectance(10, slice=9), 'slice is 9', 'from 0 to 0'),
            (lambda: crystal().array('b', count=np.array(4), element={}), 'count is array(4)'),
            (lambda: results.events(slice(0, 1)), 'the point is slice'),
            (lambda: crystal().simulation(threads=2**40), 'threads is 1099511627776', 'to 4096'),
            (lambda: goniometer('polished', 10, wavelength_nm=10**400), 'wavelength_nm is 1000'),
            (lambda: crystal().run(photons=10**5000), 'photons is a number of very many digits'),
            (lambda: scintray.Medium('a\ud800'), 'not Unicode'),
            (lambda: scintray.open_results('a\udcff'), 'not Unicode'),
            (lambda: table.write(None), 'path is None'),
            (lambda: synthesize('gaussian'), 'rms_height_um and correlation_length_um'),
            (lambda: synthesize('gaussian', rms_height_um='a', correlation_length_um=1), "rms_height_um is 'a'"),
            (lambda: synthesize('gaussian', rms_height_um=1, correlation_length_um=-1), 'correlation_length_um is -1'),
            (lambda: synthesize('ground', seed=-1), 'seed is -1'),
            (lambda: synthesize('ground', points=-1), 'points is -1'),
            (lambda: synthesize('ground', points=10**9), 'points is 1000000000', 'to 16384'),
            (lambda: synthesize(['ground']), 'kind of map'),
            (lambda: scintray.HeightMap('abc', 1.0), 'heights_um is not an array of numbers'),
            (lambda: scintray.HeightMap(np.zeros((4, 4)), [1, 2, 3]), 'pitch_um has 3 numbers'),
            (lambda: scintray.HeightMap(np.zeros((4, 4)), 1.0, title=5), 'title is 5'),
            (lambda: scintray.HeightMap.read(5), 'path is 5'),
            (lambda: scintray.HeightMap.read('a.txt', pitch_um='1'), "pitch_um is '1'"),
            (lambda: goniometer(7, 10), 'surface is 7'),
            (lambda: goniometer('polished', 10, seed=-1), 'seed is -1'),
            (lambda: goniometer('polished', 10, definitions=5), 'definitions is 5'),
            (lambda: goniometer('polished', 10, wavelength_nm=True), 'wavelength_nm is True'),
            (lambda: scintray.Medium(7), 'name is 7'),
            (lambda: scintray.ResponseMap.build(detector(), seed=-1), 'seed is -1'),
            (lambda: scintray.ResponseMap.build(detector(), direction='up'), "direction is 'up'", '"forward"'),
            (lambda: scintray.ResponseMap.build(7), '7 is not a scene'),
            (lambda: scintray.ResponseMap.read(b'x'), "path is b'x'"),
            (lambda: scintray.fit(7), '7 is not a scene'),
            (lambda: scintray.reweight('x.h5', 7, [1]), 'name is 7'),
            (lambda: scintray.reweight('x.h5', 'LSO', ['a']), 'values is not an array'),
            (lambda: results.analyze(settings=7), 'settings is 7'),
            (lambda: results['a'], "point is 'a'"),
            (lambda: results.events('a'), "point is 'a'"),
            (lambda: scintray.open_results(3), 'path is 3'),
            (lambda: crystal().run(photons=10**30), 'photons is 1000000'),
            (lambda: crystal().run(output=5), 'output is 5'),
            (lambda: crystal().simulation(quick='no'), "quick is 'no'"),
            (lambda: crystal()[5], '5 is not the path of a key'),
            (lambda: crystal().part('b', faces=7), 'faces is 7'),
            (lambda: crystal().part('b', faces=[7]), 'a face is 7'),
            (lambda: crystal().part(7), 'name is 7'),
            (lambda: crystal().array('b', count=4, element={}), 'count is 4'),
            (lambda: crystal().array('b', count=[2, 2], element=5), 'element is 5'),
            (lambda: crystal().sweep('run.seed', 5), 'values is 5'),
            (lambda: scintray.Scene.from_text(5), 'text of a scene is 5'),
            (lambda: scintray.Scene.load(5), 'path is 5'),
            (lambda: scintray.Scene.load('a\0b'), 'character'),
            (lambda: scintray.quantity(2, 5), 'unit is 5'),
            (lambda: scintray.Mesh(BOX_VERTICES, BOX_TRIANGLES, unit=5), 'unit is 5'),
            (lambda: scintray.Deposits([0], [[0, 0, 0]], [1], length_unit=['mm']), "['mm'] is not a unit of length"),
            (lambda: scintray.PhotonList([[0, 0, 0]], [[0, 0, 1]], [420], wavelength_unit=1), '1 is not a unit'),
        )
        for work, *words in cases:
            with self.subTest(words[0]):
                self.assertTrue(self.refused(work, *words).problems[0].hint)

    def test_numbers_may_be_those_of_other_packages(self):
        flat = scintray.HeightMap(np.zeros((8, 8)), 1.0, periodic=np.bool_(True))
        table = flat.table(np.float32(1.5), rays=1e2, seed=np.uint8(3), directional=0)
        self.assertEqual(table.reflectance(np.array(10.0), slice=-1).shape, ())
        self.assertEqual(flat.visible_slope(np.array(10.0), rays=np.int64(100)).value, 0.0)
        self.assertEqual(crystal().run(photons=1e3)[0].photons, 1000)
        scene = crystal()
        for i in np.arange(2):
            scene['part', i, 'medium'] = 'glass'
        self.assertEqual([part['medium'] for part in scene['part']], ['glass', 'glass'])
        scintray.HeightMap.synthesize('gaussian', points=64, rms_height_um=0.3, correlation_length_um=2.0, lay_length_um=0)
        scene.array('b', count=(2, 3), element=[('medium', 'LSO')])
        self.assertEqual(scene['array.b.count'], [2, 3])

    def test_files_that_cannot_be_written(self):
        mesh = scintray.Mesh(BOX_VERTICES, BOX_TRIANGLES, unit='mm')
        for write in (crystal().save, mesh.write):
            with self.assertRaises(scintray.SystemFailure) as caught:
                write(self.folder / 'no/such/file')
            self.assertIn('no/such/file cannot be written: No such file or directory; hint:', str(caught.exception))

    def test_an_error_of_progress_ends_all_work_that_reports(self):
        def progress(done, of, thing):
            raise KeyError('from the callback')
        scene = scintray.Scene.load(SOURCE / 'scenes/fit_depth_curve.toml')
        heights = scintray.HeightMap.synthesize('gaussian', points=128, rms_height_um=0.3, correlation_length_um=2.0)
        for work in (lambda: heights.table(1.8, rays=20_000, progress=progress),
                     lambda: scintray.ResponseMap.build(detector(), photons_per_cell=50_000_000, progress=progress),
                     lambda: scintray.fit(scene, photons=2000, progress=progress)):
            with self.assertRaises(KeyError) as caught:
                work()
            self.assertIn('from the callback', str(caught.exception))

    def test_an_error_can_be_printed_and_its_problems_read(self):
        problem = scintray.Problem('a box of 0 mm', 'give a length', 'x.toml', 3, 7, source='box = 0')
        self.assertEqual(str(problem), 'x.toml:3:7: a box of 0 mm\n    box = 0\n  hint: give a length')
        again = pickle.loads(pickle.dumps(scintray.InputError([problem])))
        self.assertEqual(again.problems, [problem])


if __name__ == '__main__':
    main()
