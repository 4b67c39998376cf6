"""tools/limits counts and times; see there."""

import argparse
import concurrent.futures
import dataclasses
import json
import os
import resource
import statistics
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(1, str(Path(__file__).resolve().parents[1]))
import bench_program  # noqa: E402
import callgrind_file  # noqa: E402
import report  # noqa: E402
import rows  # noqa: E402
import version_scenes  # noqa: E402

ROUNDS = 3


def arguments():
    parser = argparse.ArgumentParser(prog='tools/limits', description='Instructions, loads, stores and wrong predictions a segment, '
                                     'the time that they take, and what is left for a required factor over an earlier version.')
    names = [row.scene for row in rows.ROWS]
    parser.add_argument('program', type=Path, help=argparse.SUPPRESS)
    parser.add_argument('--scene', action='append', metavar='NAME', choices=names, help=f'of {", ".join(names)}; may be repeated')
    parser.add_argument('--before', type=Path, metavar='PROGRAM', help='scintray of the version that factors are over: 0.1')
    parser.add_argument('--before-tree', default='', metavar='FOLDER', help='the repository that it is built from')
    parser.add_argument('--seconds', type=float, default=2.0, help='timed tracing of a scene, about')
    parser.add_argument('--counts', type=Path, metavar='FILE', help='take counts from this file, or count and write it: for '
                        'times alone, again; of the same programs')
    return parser.parse_args()


def counted_before(options, scene, row, folder):
    """Instructions a segment of the earlier version, as the difference of two runs."""
    totals, unit = [], scene.size[0]
    path = version_scenes.write(scene, folder, for_other=True)
    for work in (row.work, 3 * row.work):
        output = Path(folder) / 'counts'
        ran = version_scenes.run([*bench_program.CALLGRIND, f'--callgrind-out-file={output}', str(options.before)],
                                 options.before_tree, path, [unit, str(work)], folder)
        counted = callgrind_file.read(output).values()
        totals.append((ran.segments, sum(counts.get('Ir', 0) for counts in counted)))
    (fewer, less), (segments, instructions) = totals
    return (instructions - less) / (segments - fewer)


def nanoseconds_before(options, scene, folder):
    """Processor time a segment (ns) of the earlier version: of a run less a short one, so that building is left out."""
    path, (unit, size) = version_scenes.write(scene, folder, for_other=True), scene.size
    runs = []
    for work in (int(size) // 8, int(size)):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        ran = version_scenes.run([str(options.before)], options.before_tree, path, [unit, str(work)], folder)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        runs.append((ran.segments, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime))
    (fewer, less), (segments, seconds) = runs
    return 1e9 * (seconds - less) / (segments - fewer)


def timed(options, program, chosen, widths):
    """ns a segment of the rows, and of what they are compared with, in turns: {scene: {lanes: ns}}, {scene: ns before}."""
    scenes = sorted({row.scene for row in chosen} | {row.of for row in chosen if row.of})
    now = {scene: {width: [] for width in widths} for scene in scenes}
    before = {row.scene: [] for row in chosen if options.before and not row.of}
    by_title = {scene.title: scene for scene in version_scenes.ROWS}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(ROUNDS):
            for scene in scenes:
                for width in widths:
                    now[scene][width] += program.nanoseconds([scene], width, options.seconds / ROUNDS).values()
                if scene in before:
                    before[scene].append(nanoseconds_before(options, by_title[scene], folder))
    return ({scene: {width: statistics.median(values) for width, values in of.items()} for scene, of in now.items()},
            {scene: statistics.median(values) for scene, values in before.items()})


def counted(options, program, row):
    """Counts of a row, and instructions a segment of the earlier version."""
    print(f'counting {row.scene}', file=sys.stderr, flush=True)
    counts = program.counts(row.scene, report.COUNTED_LANES, row.work)
    if not options.before or row.of:
        return counts, None
    scene = next(scene for scene in version_scenes.ROWS if scene.title == row.scene)
    with tempfile.TemporaryDirectory() as folder:
        return counts, counted_before(options, scene, row, folder)


def counts_of(options, program, chosen):
    """{scene: (counts, instructions before)}, those kept in a file among them."""
    kept = {}
    if options.counts and options.counts.exists():
        kept = {scene: (bench_program.SceneCounts.of_plain(counts), instructions)
                for scene, (counts, instructions) in json.loads(options.counts.read_text(encoding='utf-8')).items()}
    missing = [row for row in chosen if row.scene not in kept]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        kept.update(zip((row.scene for row in missing), pool.map(lambda row: counted(options, program, row), missing)))
    if options.counts and missing:
        plain = {scene: (dataclasses.asdict(counts), instructions) for scene, (counts, instructions) in kept.items()}
        options.counts.write_text(json.dumps(plain, indent=1) + '\n', encoding='utf-8')
    return kept


def measured(options, program, widths):
    chosen = [row for row in rows.ROWS if not options.scene or row.scene in options.scene]
    counts = counts_of(options, program, chosen)
    print('timing', file=sys.stderr, flush=True)
    now, before = timed(options, program, chosen, widths)
    return [report.Figures(row, counts[row.scene][0], now[row.scene], now.get(row.of, {}),
                           report.Before(counts[row.scene][1], before[row.scene]) if row.scene in before else None)
            for row in chosen]


def main():
    options = arguments()
    program = bench_program.BenchProgram(options.program)
    try:
        machine = program.machine()
        widths = [width for width in (report.COUNTED_LANES, 8) if width in machine['lane_widths']]
        if report.COUNTED_LANES not in widths:
            raise bench_program.Failed('this processor has no AVX2, in which the kernels are counted')
        figures = measured(options, program, widths)
    except (bench_program.Failed, version_scenes.Refused, ValueError) as error:
        sys.exit(f'error: {error}')
    print(report.text_of(figures, machine, program.version), end='')


if __name__ == '__main__':
    main()
