"""Media, the goniometer, tables, height maps, response maps, fits and reweighting."""

import matplotlib.pyplot as plt
import numpy as np

import scintray
from support import SOURCE, Case, crystal, detector, main, program


class Surfaces(Case):
    def test_a_polished_surface_has_fresnels_reflectance(self):
        reading = scintray.goniometer('polished', [0, 20, 40, 60], inside='LSO', rays=40_000)
        n1, n2 = reading.index
        angle = np.radians(reading.incidence_deg)
        cosine = np.sqrt(np.maximum(0.0, 1 - (n1 / n2 * np.sin(angle))**2))
        s = ((n1 * np.cos(angle) - n2 * cosine) / (n1 * np.cos(angle) + n2 * cosine))**2
        p = ((n1 * cosine - n2 * np.cos(angle)) / (n1 * cosine + n2 * np.cos(angle)))**2
        expected = np.where(cosine > 0, 0.5 * (s + p), 1.0)
        # Five standard errors: four angles fail by chance once in 400,000 times.
        self.assertTrue((abs(reading.reflectance[:, 0] - expected) <= 5 * reading.reflectance[:, 1]).all())
        total = reading.reflectance[:, 0] + reading.transmittance[:, 0] + reading.absorptance[:, 0]
        np.testing.assert_allclose(total, 1.0)
        self.assertEqual(reading.plot().get_xlabel(), 'angle of incidence (deg)')
        self.assertEqual(reading.to_dataframe().attrs['units']['incidence_deg'], 'deg')
        self.assertEqual(reading.to_xarray()['reflected_per_sr'].shape, (4, 180))
        plt.close('all')

    def test_a_definition_in_a_text(self):
        text = '[surfaces.mine]\nmodel = "unified"\n' \
            'unified = { sigma_alpha = "12 deg", definition = "solid_angle", facets = "geant4", lobe = 1.0 }\n'
        self.assertIn('mine', scintray.names('surfaces', text))
        self.assertNotIn('mine', scintray.surfaces())
        one = scintray.goniometer('mine', 45, rays=5000, definitions=text)
        np.testing.assert_array_equal(one.reflectance,
                                      scintray.goniometer('mine', 45, rays=5000, definitions=text).reflectance)
        self.assertEqual(one.plot().get_ylabel(), 'light per solid angle (1/sr)')
        plt.close('all')

    def test_media_are_those_of_the_database(self):
        lyso = scintray.Medium('LYSO', [400, 420, 500])
        self.assertGreater(lyso.index[0], lyso.index[2])
        self.assertTrue((lyso.group_index > lyso.index).all())
        self.assertGreater(lyso.yield_per_keV, 20)
        self.assertAlmostEqual(sum(share for _, _, share in lyso.decay), 1.0)
        self.assertEqual(lyso.to_dataframe().attrs['units']['wavelength_nm'], 'nm')
        self.assertIn('LYSO', lyso._repr_html_())
        lyso.plot()
        plt.close('all')


class Maps(Case):
    def setUp(self):
        super().setUp()
        self.map = scintray.HeightMap.synthesize('gaussian', points=96, pitch_um=0.2, rms_height_um=0.3,
                                                 correlation_length_um=2.0)

    def test_heights_and_statistics(self):
        heights = self.map.heights_um
        self.assertEqual(heights.shape, (96, 96))
        self.assertFalse(heights.flags.writeable)
        self.assertAlmostEqual(heights.std(), self.map.statistics['sq_um'], 12)
        self.assertAlmostEqual(self.map.statistics['sq_um'], 0.3, 9)
        again = scintray.HeightMap(heights, self.map.pitch_um, periodic=True)
        np.testing.assert_array_equal(again.heights_um, heights)
        self.assertEqual(again.statistics['sdq'], self.map.statistics['sdq'])
        self.map.write(self.folder / 'map.gsf')
        read = scintray.HeightMap.read(self.folder / 'map.gsf')
        np.testing.assert_allclose(read.heights_um, heights, atol=1e-6)
        self.assertEqual(self.map.plot().get_xlabel(), 'x (um)')
        plt.close('all')

    def test_preparation_levels_a_slope(self):
        y, x = np.mgrid[0:40, 0:50]
        tilted = scintray.HeightMap(0.01 * x - 0.02 * y, 1.0)
        self.assertGreater(tilted.statistics['sq_um'], 0.1)
        level = tilted.prepared(level=1)
        self.assertLess(level.statistics['sq_um'], 1e-9)
        self.assertGreater(len(level.steps), len(tilted.steps))
        self.assertGreater(tilted.prepared(level=None).statistics['sq_um'], 0.1)

    def test_a_flat_map_tabulates_fresnels_reflectance(self):
        table = scintray.HeightMap(np.zeros((8, 8)), 1.0, periodic=True).table(1.82, 1.0, rays=200)
        np.testing.assert_allclose(table.reflectance(60), 1.0)
        normal = table.slices[0]['inside']
        r, error = normal['reflectance'][0]
        self.assertLess(abs(r - (0.82 / 2.82)**2), 5 * error)
        np.testing.assert_allclose(normal['mean_slope_rad'], 0.0, atol=1e-9)
        table.write(self.folder / 'table.h5')
        again = scintray.SurfaceTable.read(self.folder / 'table.h5')
        np.testing.assert_array_equal(again.slices[0]['outside']['reflectance'],
                                      table.slices[0]['outside']['reflectance'])
        self.assertEqual(again.plot().get_ylabel(), 'reflectance')
        self.assertIn('Surface table', again._repr_html_())
        plt.close('all')

    def test_a_table_can_be_stopped(self):
        calls = []
        with self.assertRaises(scintray.Cancelled):
            self.map.table(1.82, rays=50_000, progress=lambda *call: calls.append(call) or False)
        self.assertEqual(len(calls), 1)


class Mapped(Case):
    def test_events_from_a_map_are_those_of_the_program(self):
        scene = detector(400)
        response = scintray.ResponseMap.build(scene, pitch_mm=2.0, photons_per_cell=2000)
        self.assertEqual(response.channels, scene.run(events=2).events().channels['name'])
        self.assertEqual(response.grids['crystal']['detected'].shape, (1, 1, 5, 2))
        share = response.probability('crystal')
        self.assertTrue(((share > 0) & (share < 1)).all())
        response.write(self.folder / 'map.h5')
        scene.save(self.folder / 'scene.toml')
        program('response', 'run', 'scene.toml', 'map.h5', '-o', 'run.h5', '--no-report', folder=self.folder)
        theirs = scintray.open_results(self.folder / 'run.h5').events()
        for map_ in (response, scintray.ResponseMap.read(self.folder / 'map.h5')):
            np.testing.assert_array_equal(map_.run(scene).events().channel_detected, theirs.channel_detected)
        # Traced, the light is the same within its errors.
        traced = scene.run().events().light
        mapped = theirs.channel_detected.sum(axis=1)
        error = np.hypot(traced.std(), mapped.std()) / np.sqrt(400)
        self.assertLess(abs(traced.mean() - mapped.mean()), 5 * error + 0.03 * traced.mean())
        response.plot()
        plt.close('all')

    def test_a_fit_finds_what_the_program_finds(self):
        scene = scintray.Scene.load(SOURCE / 'scenes/fit_depth_curve.toml')
        fit = scintray.fit(scene, photons=1000, output=self.folder / 'fit.h5')
        self.assertTrue((self.folder / 'fit.h5').exists())
        self.assertEqual(fit.end, 'converged')
        self.assertEqual(list(fit.parameters), ['sigma_alpha', 'absorption length'])
        alpha = fit.parameters['sigma_alpha']
        self.assertTrue(alpha.low <= alpha.value.value <= alpha.high)
        self.assertGreater(alpha.value.error, 0.0)
        self.assertEqual(len(fit.x), len(fit.curve))
        self.assertEqual(fit.correlation.shape, (2, 2))
        self.assertEqual(fit.plot().get_ylabel(), fit.quantity)
        self.assertEqual(len(fit.to_dataframe()), len(fit.x))
        plt.close('all')

    def test_reweighting_by_one_changes_nothing_and_shorter_absorption_dims(self):
        scene = crystal(20_000)
        scene['run.photon_history'] = True
        scene.run(output=self.folder / 'run.h5')
        one, half = scintray.reweight(self.folder / 'run.h5', 'LSO', [1.0, 0.5], factors=True)
        self.assertEqual(one['detected'].value, one['traced'].value)
        self.assertLess(half['detected'].value, one['detected'].value)
        self.assertTrue(half['valid'])
        self.refused(lambda: scintray.reweight(self.folder / 'run.h5', 'LSP', [1]), 'LSP', 'LSO')


if __name__ == '__main__':
    main()
