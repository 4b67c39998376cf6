"""Uncertainties, tallies, analysis, tables and plots of results."""


import matplotlib.pyplot as plt
import numpy as np

import scintray
from support import Case, crystal, detector, main


class Numbers(Case):
    def test_fates_have_binomial_errors_and_sum_to_one(self):
        point = crystal(5000).run()[0]
        self.assertEqual(point.photons, 5000)
        self.assertEqual(int(point.fate_count.sum()), point.photons_traced)
        self.assertAlmostEqual(sum(share.value for share in point.fates.values()), 1.0, 12)
        p = point.detected.value
        b = point.birth_efficiency
        self.assertAlmostEqual(p, b * point.fate_count[0] / point.photons_traced, 12)
        self.assertAlmostEqual(point.detected.error, b * np.sqrt(p / b * (1 - p / b) / point.photons_traced), 12)
        self.assertEqual(point.absorbed_in_medium['LSO'], point.fate_count[point.fate_names.index('absorbed_in_medium')])
        self.assertEqual(point.sensor_faces['detected'].sum(), point.fate_count[0])
        self.assertEqual(point.detected_time_ns.count, point.fate_count[0])

    def test_tallies_have_axes_units_and_errors(self):
        scene = crystal(5000)
        scene.tally('count', name='depth and time', at='detected', axes=[
            {'variable': 'start', 'along': [0, 0, 1], 'from': '0 mm', 'to': '10 mm', 'bins': 5},
            {'variable': 'time', 'from': '0 ns', 'to': '100 ns', 'bins': 20}])
        scene.tally('count', name='parts', at='detected', axes=[{'variable': 'part'}])
        point = scene.run()[0]
        tally = point.tally('depth and time')
        self.assertEqual(tally.sum.shape, (5, 20))
        self.assertEqual([axis.unit for axis in tally.axes], ['mm', 'ns'])
        np.testing.assert_allclose(tally.axes[0].edges, np.linspace(0, 10, 6))
        self.assertEqual(tally.sum.sum() + tally.outside, point.fate_count[0])
        n = tally.sum[tally.sum > 0]
        np.testing.assert_allclose(tally.error[tally.sum > 0], np.sqrt(n - n**2 / 5000))
        np.testing.assert_allclose(tally.per_photon, tally.sum / 5000)
        self.assertIn('pmt', point.tally('parts').axes[0].names)
        dataset = tally.to_xarray()
        self.assertEqual(dataset['start'].attrs['units'], 'mm')
        self.assertEqual(float(dataset['sum'].sum()), tally.sum.sum())

    def test_estimates_print_with_the_digits_of_their_errors(self):
        self.assertEqual(str(scintray.Estimate(0.123456, 0.00234)), '0.1235 ± 0.0023')
        self.assertEqual(str(scintray.Estimate(12345.6, 234.0)), '12346 ± 234')
        self.assertEqual(scintray.Estimate(1.0, 0.3).sigmas_from(scintray.Estimate(2.0, 0.4)), 2.0)


class Analyses(Case):
    @classmethod
    def setUpClass(cls):
        scene = detector(600)
        scene['part.crystal.surface'] = 'roncali2013_unified_rough'
        cls.results = scene.run()
        cls.analysis = cls.results.analyze()

    def test_the_photopeak_is_where_the_events_are(self):
        events, peak = self.results.events(), self.analysis.photopeak
        self.assertTrue(peak.converged)
        mean, error = events.light.mean(), events.light.std() / np.sqrt(len(events))
        self.assertLess(peak.position.sigmas_from(scintray.Estimate(mean, error)), 5.0)
        self.assertEqual(self.analysis.spectrum.counts.sum() + self.analysis.spectrum.below
                         + self.analysis.spectrum.above, (events.light > 0).sum())
        self.assertAlmostEqual(self.analysis.mean_light.value, mean, 6)

    def test_a_fit_that_did_not_converge_has_no_numbers(self):
        few = detector(5).run().analyze()
        self.assertFalse(few.photopeak.converged)
        self.assertTrue(np.isnan(few.photopeak.relative_fwhm.value))
        self.assertEqual(few.photopeak.status, 'too few events')
        self.assertIsNone(few.ctr)
        self.assertTrue(any('timing' in reason for reason in few.left_out))

    def test_settings_in_text_replace_those_of_the_scene(self):
        other = self.results.analyze(settings='[analysis]\nslices = 4\n'
                                              'depth = { from = ["0 mm", "0 mm", "0 mm"], along = [0, 0, 1] }')
        self.assertLessEqual(len(other.light_against_depth.depth_mm), 4)
        self.assertGreater(len(self.analysis.light_against_depth.depth_mm), 4)

    def test_depth_of_interaction_and_timing(self):
        self.assertIsNotNone(self.analysis.doi)
        self.assertLess(self.analysis.doi.fwhm.value, 10.0)
        self.assertGreater(self.analysis.ctr.fwhm_ns.value, 0.0)
        self.assertGreater(self.analysis.ctr.count, 100)

    def test_everything_is_drawn_and_shown(self):
        figure = self.analysis.plot()
        self.assertGreaterEqual(len(figure.axes), 4)
        for thing in (self.results, self.results[0], self.analysis):
            self.assertIn('<table>', thing._repr_html_())
            self.assertTrue(repr(thing))
        ax = self.results.events().plot()
        self.assertEqual(ax.get_ylabel(), 'events per bin')
        plt.close('all')

    def test_tables_have_units(self):
        frame = self.results.events().to_dataframe()
        self.assertEqual(len(frame), 600)
        self.assertEqual(frame.attrs['units']['energy_keV'], 'keV')
        self.assertEqual(set(frame['part']), {'crystal'})
        dataset = self.results.events().to_xarray()
        self.assertEqual(dataset['first_ns'].attrs['units'], 'ns')
        self.assertEqual(dataset['channel_detected'].shape, (600, 2))
        curve = self.analysis.light_against_depth.to_dataframe()
        self.assertEqual(curve.attrs['units']['depth_mm'], 'mm')


class Sweeps(Case):
    def test_a_sweep_as_table_dataset_and_plot(self):
        scene = crystal(500).sweep('part.crystal.surface', ['polished', 'roncali2013_unified_rough'], label='surface')
        scene.sweep('source.region.slab_z', [['1 mm', '2 mm'], ['5 mm', '6 mm'], ['8 mm', '9 mm']], label='slab')
        scene['run.photon_list'] = True
        results = scene.run()
        frame = results.to_dataframe()
        self.assertEqual(list(frame.columns[:3]), ['surface', 'slab', 'photons'])
        self.assertEqual(len(frame), 6)
        np.testing.assert_array_equal(frame['detected_error'], results.detected[:, 1])
        dataset = results.to_xarray()
        np.testing.assert_array_equal(dataset['fraction'].sel(fate='detected'), results.detected[:, 0])
        photons = results.photons_dataframe()
        self.assertEqual(photons.attrs['units']['time_ns'], 'ns')
        self.assertEqual(photons.attrs['units']['x_mm'], 'mm')
        self.assertEqual(len(photons), sum(point.fate_count[0] for point in results))
        ax = results.plot()
        self.assertEqual(len(ax.get_legend().get_texts()), 2)
        self.assertIn('<td>polished</td>', results._repr_html_().replace(" style='text-align:left'", ''))
        plt.close('all')

    def test_tallies_and_scenes_are_drawn(self):
        scene = crystal(1000)
        scene.tally('count', name='one', at='detected', axes=[{'variable': 'time', 'from': '0 ns', 'to': '9 ns', 'bins': 9}])
        scene.tally('count', name='two', at='detected', axes=[{'variable': 'part'},
                    {'variable': 'time', 'from': '0 ns', 'to': '9 ns', 'bins': 9}])
        point = scene.run()[0]
        self.assertEqual(point.tally('one').plot().get_xlabel(), 'time (ns)')
        self.assertEqual(point.tally('two').plot().get_ylabel(), 'time (ns)')
        self.assertIn('one', point.tally('one')._repr_html_())
        ax = scene.plot(plane='yz')
        self.assertEqual(ax.get_xlabel(), 'y (mm)')
        low, high = ax.get_ylim()
        self.assertLess(low, -1.0)
        self.assertGreater(high, 10.0)
        self.assertIn('crystal', scene._repr_html_())
        plt.close('all')

    def test_without_an_optional_package_the_error_names_it(self):
        import sys
        from unittest import mock
        point = crystal(100).run()[0]
        with mock.patch.dict(sys.modules, {'matplotlib.pyplot': None}):
            with self.assertRaises(scintray.MissingPackage) as caught:
                point.plot()
        self.assertIn('python3-matplotlib', str(caught.exception))


if __name__ == '__main__':
    main()
