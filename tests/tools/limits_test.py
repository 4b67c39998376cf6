"""tools/limits: what a file of callgrind counts, and what follows for a factor; the scenes that other versions read."""

import dataclasses
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / 'tools'
sys.dont_write_bytecode = True
sys.path[:0] = [str(TOOLS / 'lib'), str(TOOLS / 'lib/limits')]
import callgrind_file  # noqa: E402
import report  # noqa: E402
import rows  # noqa: E402
import version_scenes  # noqa: E402
from bench_program import KERNEL, SINGLE, TRACE, VECTORS, BenchProgram, Counts, SceneCounts  # noqa: E402

# A function with an inlined line, that calls another one twice; then names by their numbers alone.
FILE = '''# callgrind format
version: 1
positions: line
events: Ir Dr Dw Bc Bcm Bi Bim
summary: 1000 0 0 0 0 0 0

ob=(1) /bin/scintray_bench
fl=(1) /x/src/scintray/transport/step.cpp
fn=(1) step(int)
10 5 1 1
+2 3
fi=(2) /x/src/scintray/core/rng.hpp
7 20 2 0 4 1
fe=(1)
12 1
cob=(2) /lib/libembree3.so.3
cfi=(3) ???
cfn=(2) rtcIntersect1
calls=2 0
* 400 100
-1 2 0 0 1 0 1 1
ob=(2)
fl=(3)
fn=(2)
0 400 100

ob=(1)
fl=(1)
fn=(1)
10 1
totals: 432
'''


def read(text):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / 'counts'
        path.write_text(text)
        return callgrind_file.read(path)


def figures(ns, before_ns, outside=60.0, factor=4.0):
    kernels = 100.0 - outside
    counts = SceneCounts(5.0, Counts(100.0, 20.0, 10.0, 1.0), Counts(kernels), {'emission': Counts(outside)},
                         {VECTORS: 0.25 * kernels, SINGLE: 0.75 * kernels})
    return report.Figures(rows.Row('scene', factor, 1), counts, {4: ns}, {}, report.Before(200.0, before_ns))


class Limits(unittest.TestCase):
    def test_counts_are_of_the_place_itself_with_inlined_lines_apart(self):
        counted = read(FILE)
        step = callgrind_file.Place('/bin/scintray_bench', '/x/src/scintray/transport/step.cpp', 'step(int)')
        drawn = step._replace(file='/x/src/scintray/core/rng.hpp')
        embree = callgrind_file.Place('/lib/libembree3.so.3', '???', 'rtcIntersect1')
        self.assertEqual(set(counted), {step, drawn, embree})
        self.assertEqual(Counts.of(counted[step]), Counts(12, 1, 1, 1))
        self.assertEqual(Counts.of(counted[drawn]), Counts(20, 2, 0, 1))
        self.assertEqual(Counts.of(counted[embree]), Counts(400, 100, 0, 0))
        self.assertEqual(Counts.of({'Ir': 9, 'I1mr': 2}), Counts(instructions=9, code_misses=2))

    def test_a_difference_leaves_out_what_is_the_same(self):
        less, more = read(FILE), read(FILE.replace('0 400 100\n', '0 900 150\n'))
        different = callgrind_file.difference(more, less)
        self.assertEqual([place.function for place in different], ['rtcIntersect1'])
        self.assertEqual(next(iter(different.values()))['Ir'], 500)

    def test_kernels_are_the_functions_in_lanes(self):
        for name in ('scintray::transport::(anonymous namespace)::LanePasses<scintray::transport::LaneRealPair<xsimd::avx2> >::run()',
                     'scintray::transport::(anonymous namespace)::LanesInBox<scintray::core::LaneReal<xsimd::avx2> >::pass(scintray::transport::LaneWork* const (&) [4]) const',
                     'scintray::transport::propagate_lanes_4(scintray::transport::LanePlanes const&)',
                     'scintray::transport::refract_lanes_8(scintray::transport::LaneNormal const*)',
                     'scintray::transport::propagate_lanes_in_body_8(scintray::transport::LaneBody const&)'):
            self.assertTrue(KERNEL.search(name), name)
        for name in ('scintray::transport::SurfaceLanes::enter(unsigned int)', 'scintray::transport::propagate_lanes(int)'):
            self.assertFalse(KERNEL.search(name), name)

    def test_what_is_counted_is_found_by_its_name_whatever_its_parameters(self):
        names = ('0000 t std::_Function_handler<void (), bench::Workload::trace(int) const::{lambda()#1}>::_M_invoke()\n'
                 '0001 t scintray::bench::Workload::trace(unsigned long, int) const [clone .cold]\n'
                 '0002 T scintray::bench::Workload::trace(unsigned long, int, std::optional<int>) const\n')
        self.assertEqual(TRACE.findall(names), ['scintray::bench::Workload::trace(unsigned long, int, std::optional<int>) const'])

    def test_kernels_are_divided_by_the_files_of_their_lines(self):
        program = BenchProgram('/bin/scintray_bench')
        program.ask = lambda request: {'kinds': ['propagation'] * len(request['kinds_of'])}
        counted = {callgrind_file.Place('/bin/scintray_bench', file, 'LanePasses<int>::run()'): {'Ir': count}
                   for file, count in (('/usr/lib/gcc/x86_64-linux-gnu/12/include/avx2intrin.h', 10), ('/usr/include/xsimd/a.hpp', 20),
                                       ('/x/src/scintray/core/lanes/lane_number.hpp', 160),
                                       ('/x/src/scintray/optics/table_laws.hpp', 80))}
        result = program.attributed(counted, 10, 5.0)
        self.assertEqual(result.in_kernels, {VECTORS: 19.0, SINGLE: 8.0})
        self.assertEqual(result.kernels.instructions, 27.0)

    def test_counts_go_to_the_kinds_that_the_program_says(self):
        program = BenchProgram('/bin/scintray_bench')
        asked = []

        def ask(request):
            asked.extend(request['kinds_of'])
            return {'kinds': ['ray query' if library else 'propagation' for library, _, _ in request['kinds_of']]}
        program.ask = ask
        result = program.attributed(read(FILE), 10, 5.0)
        self.assertIn(['libembree3.so.3', '???', 'rtcIntersect1'], asked)
        self.assertIn(['', '/x/src/scintray/core/rng.hpp', 'step(int)'], asked)
        self.assertEqual(result.by_kind['ray query'].instructions, 40.0)
        self.assertEqual(result.by_kind['propagation'].instructions, 3.2)
        self.assertEqual(result.whole.instructions, 43.2)
        self.assertEqual(SceneCounts.of_plain(dataclasses.asdict(result)), result)

    def test_a_factor_is_met_or_says_what_it_would_take(self):
        self.assertEqual(report.conclusion(figures(10.0, 40.0)), 'met')
        # A quarter of 200 leaves 50 instructions, less than the 60 outside of the kernels.
        self.assertEqual(report.conclusion(figures(20.0, 40.0)), 'what is not in kernels takes 1.20 of them')
        self.assertEqual(report.conclusion(figures(20.0, 40.0, outside=30.0)), 'kernels in 20 in place of 70')
        # Half of 200 leaves all 100.
        self.assertEqual(report.conclusion(figures(30.0, 40.0, factor=2.0)), 'few enough, at fewer a ns than before')
        # 15 are left for kernels, a quarter of whose 90 is in vectors.
        self.assertEqual(report.conclusion(figures(20.0, 40.0, outside=10.0, factor=8.0)),
                         'vectors alone take 1.50 of what is left for kernels')
        alone = figures(20.0, 40.0, outside=100.0)
        alone.counts.by_kind['ray query'] = Counts(25.0)
        self.assertEqual(report.conclusion(alone), 'no kernels; the ray query alone takes 0.50 of them')
        self.assertEqual(report.required_nanoseconds(figures(20.0, 40.0)), 10.0)
        # Over another scene, by its time now: 8 ns / 0.8 of the 20 ns that 100 instructions take.
        other = dataclasses.replace(figures(20.0, 40.0), row=rows.Row('scene', 0.8, 1, of='one'), of_nanoseconds={4: 8.0})
        self.assertEqual(report.instructions_left(other), 50.0)

    def test_what_is_needed_leaves_out_emission_and_single_lanes(self):
        # 50 instructions are left; kernels need 20 and 5 of their 40, and 45 of the 60 outside are not emission.
        some = figures(20.0, 40.0)
        some.counts.in_kernels.update({VECTORS: 25.0, SINGLE: 15.0})
        some.counts.by_kind.update({'emission': Counts(5.0), 'random': Counts(8.0), 'elementary': Counts(2.0),
                                    'propagation': Counts(45.0)})
        self.assertEqual(report.needed_share(some), (20.0 + 5.0 + 45.0) / 50.0)
        some.before = None
        self.assertIsNone(report.needed_share(some))

    def test_tables_have_as_many_columns_in_each_line(self):
        text = report.text_of([figures(20.0, 40.0)], {'cpu': 'a processor', 'cycles_per_ns': 2.0}, 'ScintRay')
        for block in text.split('\n\n'):
            columns = {line.count('|') for line in block.splitlines() if line.startswith('|')}
            self.assertLessEqual(len(columns), 1, block)
        self.assertIn('| 8.3 |', text)  # 100 instructions at 6 a cycle of half a nanosecond

    def test_the_mesh_of_a_box_is_closed(self):
        lines = version_scenes.off_of_box(16).splitlines()
        self.assertEqual(lines[1], '1538 3072 0')
        edges = {}
        for line in lines[2 + 1538:]:
            corners = [int(word) for word in line.split()[1:]]
            for a, b in zip(corners, corners[1:] + corners[:1]):
                edges[a, b] = edges.get((a, b), 0) + 1
        self.assertTrue(all(count == 1 and edges.get((b, a)) == 1 for (a, b), count in edges.items()))

    def test_every_row_over_another_version_has_a_scene_for_it(self):
        titles = {scene.title for scene in version_scenes.ROWS}
        self.assertLessEqual({row.scene for row in rows.ROWS if not row.of}, titles)
        with tempfile.TemporaryDirectory() as folder:
            for scene in version_scenes.ROWS:
                self.assertNotIn('curved = "facets"', version_scenes.write(scene, folder, for_other=True).read_text())

    def test_the_peak_of_a_program_is_its_own_and_its_errors_are_passed_on(self):
        def started(code):
            return subprocess.run([sys.executable, '-IS', '-c', version_scenes.PEAK_OF, sys.executable, '-c', code],
                                  capture_output=True, text=True, check=False)
        here = bytearray(300_000_000)  # of this process, which must not count
        done = started('print("words"); bytearray(100_000_000)')
        peak_kiB, process_s = map(float, done.stdout.split())
        self.assertTrue(100_000 < peak_kiB * 1.024 < 200_000, done.stdout)
        self.assertGreater(process_s, 0.0)
        refused = started('raise SystemExit("no such scene")')
        self.assertEqual((refused.returncode, refused.stderr), (1, 'no such scene\n'))
        del here


if __name__ == '__main__':
    unittest.main()
