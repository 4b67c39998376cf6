"""What notebooks show of each kind of object: a table of its numbers, and a plot."""

import io
import re

import matplotlib.pyplot as plt
import numpy as np

import scintray
from support import BOX_TRIANGLES, BOX_VERTICES, SOURCE, Case, crystal, detector, main


def objects(folder):
    """One of each kind, by its name."""
    scene = detector(1500)
    scene['part.crystal.surface'] = 'roncali2013_unified_rough'
    scene['readout'] = {'sampling': '1 GHz', 'before': '20 ns', 'window': '400 ns', 'threshold': 3.0, 'photon_order': [1, 2, 3],
                        'shaping': {'order': 2, 'time_constant': '4 ns'}, 'time_pickoff': 'leading_edge'}
    scene.tally('count', name='time', at='detected', axes=[{'variable': 'time', 'from': '0 ns', 'to': '100 ns', 'bins': 20}])
    results = scene.run()
    analysis = results.analyze(settings='[analysis]\ndepth = { from = ["0 mm", "0 mm", "0 mm"], along = [0, 0, 1] }\n')
    traced = crystal(3000)
    traced['run.photon_history'] = True
    traced.run(output=folder / 'run.h5')
    fit = scintray.fit(scintray.Scene.load(SOURCE / 'scenes/fit_depth_curve.toml'), photons=300)
    heights = scintray.HeightMap.synthesize('gaussian', points=64, rms_height_um=0.3, correlation_length_um=2.0)
    return {
        'scene': scene, 'simulation': scene.simulation(), 'results': results, 'point': results[0],
        'events': results.events(), 'tally': results[0].tally('time'), 'moments': results[0].detected_time_ns,
        'analysis': analysis, 'spectrum': analysis.spectrum, 'photopeak': analysis.photopeak,
        'depth curve': analysis.light_against_depth, 'depth of interaction': analysis.doi, 'timing': analysis.ctr,
        'medium': scintray.Medium('LYSO'), 'goniometer': scintray.goniometer('polished', [10, 50], rays=500),
        'height map': heights, 'table': heights.table(1.8, rays=50),
        'response map': scintray.ResponseMap.build(scene, pitch_mm=2.0, photons_per_cell=200),
        'fit': fit, 'fit parameter': fit.parameters['sigma_alpha'],
        'reweighted light': scintray.reweight(folder / 'run.h5', 'LSO', [1.0, 0.8, 0.6], factors=True),
        'deposits': scintray.Deposits([0, 0, 1], [[0, 0, 1], [0, 0, 2], [0, 1, 3]], [100, 411, 511]),
        'photon list': scintray.PhotonList([[0, 0, 1], [0, 1, 2]], [[0, 0, 1], [0, 1, 0]], [420, 430]),
        'mesh': scintray.Mesh(BOX_VERTICES, BOX_TRIANGLES, unit='mm'),
    }


class Notebooks(Case):
    def test_every_kind_of_object_has_a_table_and_a_plot(self):
        made = objects(self.folder)
        for name, thing in made.items():
            with self.subTest(name):
                self.assertIsNotNone(thing)
                table = thing._repr_html_()
                self.assertGreater(len(re.findall('<td', table)) + len(re.findall('<th', table)), 1, table)
                self.assertLess(len(repr(thing)), 1000)
                if name in ('moments', 'fit parameter'):
                    continue  # numbers, which have no picture of their own
                plotted = thing.plot()
                figure = getattr(plotted, 'figure', plotted)
                picture = io.BytesIO()
                figure.savefig(picture, format='png')
                self.assertGreater(picture.tell(), 4000)
                plt.close('all')
        analysis = made['analysis']
        for plot, label in ((analysis.plot_timing_against_depth, 'time (ps)'),
                            (analysis.plot_ctr_by_order, 'CTR (ps FWHM)')):
            self.assertEqual(plot().get_ylabel(), label)
        plt.close('all')
        self.assertEqual(len(made['deposits'].to_dataframe()), 3)
        self.assertEqual(made['reweighted light'].to_dataframe()['detected'].iloc[0],
                         made['reweighted light'][0]['detected'].value)

    def test_texts_are_escaped(self):
        scene = crystal(100)
        scene['title'] = '<b>bold</b>'
        for shown in (scene, scene.simulation(), scene.run()):
            self.assertNotIn('<b>bold', shown._repr_html_())

    def test_names_without_what_was_recorded_say_how_to_record_it(self):
        analysis = detector(50).run().analyze()
        self.refused(analysis.plot_ctr_by_order, 'photon_order')

    def test_closed_objects_can_be_shown(self):
        simulation = crystal(100).simulation()
        simulation.close()
        self.assertIn('closed', simulation._repr_html_())

    def test_a_sweep_is_shown_point_by_point(self):
        scene = crystal(100).sweep('run.seed', [1, 2, 3])
        self.assertEqual(scene.simulation()._repr_html_().count('<tr>'), 4)
        results = scene.run()
        self.assertEqual([p.parameters for p in results[1:]], [{'run.seed': '2'}, {'run.seed': '3'}])
        self.assertEqual([p.parameters['run.seed'] for p in results[::-1]], ['3', '2', '1'])


class Bars(Case):
    def test_a_bar_has_share_rate_and_time_left_and_goes(self):
        stream = io.StringIO()
        bar = scintray.ProgressBar(stream, rewrites=True)
        bar(0, 1000, 'photons')
        bar(500, 1000, 'photons')
        bar(1000, 1000, 'photons')
        lines = stream.getvalue().split('\r')
        self.assertRegex(lines[2], r'^ 50 %  500 photons, [\d.e+]+/s, \d+ s left$')
        self.assertIn('100 %  1000 photons', lines[3])
        self.assertEqual(len(lines[3]), len(lines[2]), 'what was written before is covered')
        bar.close()
        self.assertEqual(stream.getvalue().split('\r')[-2].strip(), '')

    def test_work_shows_its_bar_on_standard_error(self):
        import sys
        class Terminal(io.StringIO):
            def isatty(self):
                return True

        def written_to(stream):
            before, sys.stderr = sys.stderr, stream
            try:
                crystal(300_000).run(progress=True)
            finally:
                sys.stderr = before
            return stream.getvalue()

        written = written_to(Terminal())
        self.assertIn('photons', written)
        self.assertTrue(written.endswith('\r'))
        self.assertEqual(written_to(io.StringIO()), '', 'a log has no line of short work')

    def test_a_log_has_a_line_now_and_then(self):
        stream = io.StringIO()
        bar = scintray.ProgressBar(stream, interval_s=0.0)
        bar(500, 1000, 'photons')
        bar(1000, 1000, 'photons')
        bar.close()
        lines = stream.getvalue().split('\n')
        self.assertRegex(lines[0], r'^ 50 %  500 photons, [\d.e+]+/s, \d+ s left$')
        self.assertEqual(lines[1:], ['100 %  1000 photons', ''])
        self.assertNotIn('\r', stream.getvalue())


class Parts(Case):
    def test_files_and_light_guides_in_code(self):
        scene = scintray.Scene('From a file', ambient='air')
        scintray.Mesh(BOX_VERTICES, BOX_TRIANGLES, unit='mm').write(self.folder / 'box.ply')
        scene.part('crystal', mesh=self.folder / 'box.ply', unit='mm', medium='LSO', surface='polished')
        scene['source'] = {'type': 'photons', 'region': {'part': 'crystal'}, 'wavelength': '420 nm', 'photons': 10}
        parts = scene.simulation().parts()
        np.testing.assert_allclose(np.ptp(parts[0]['vertices'], axis=0), [2, 2, 10])
        scene.array('crystals', count=[2, 2], pitch='2.1 mm', place={'touch': 'crystal', 'side': '+z', 'gap': '1 mm'},
                    element={'box': ['2 mm', '2 mm', '10 mm'], 'medium': 'LSO', 'surface': 'polished'})
        scene.light_guide('guide', bottom='4 mm', top='4.2 mm', height='3 mm', medium='glass', surface='polished',
                          slits={'segments': [2, 2], 'depth': '2 mm', 'width': '0.2 mm'},
                          place={'touch': 'crystals', 'side': '+z', 'gap': '0.1 mm', 'fill': 'optical_grease'})
        names = [part['name'] for part in scene.simulation().parts()]
        self.assertEqual(sum(name.startswith('crystals[') for name in names), 4)
        self.assertIn('guide_base', names)


if __name__ == '__main__':
    main()
