"""The tables of tools/limits, as Markdown."""

import dataclasses

import rows
from bench_program import SINGLE, VECTORS, SceneCounts

KINDS = ('ray query', 'propagation', 'surface', 'random', 'elementary', 'emission', 'tally', 'readout', 'other')  # the order
COUNTED_LANES = 4  # valgrind knows no AVX-512
FEW = 0.02  # share of instructions below which a scene has no kernels


@dataclasses.dataclass
class Before:
    """A scene in the earlier version."""

    instructions: float  # a segment
    nanoseconds: float


@dataclasses.dataclass
class Figures:
    """A row as measured; nanoseconds by lanes, those of the scene that it is compared with apart."""

    row: rows.Row
    counts: SceneCounts
    nanoseconds: dict
    of_nanoseconds: dict
    before: Before | None = None


def table(headings, lines):
    text = ['| ' + ' | '.join(headings) + ' |', '|' + ' --- |' + ' ---: |' * (len(headings) - 1)]
    return '\n'.join(text + ['| ' + ' | '.join(line) + ' |' for line in lines]) + '\n'


def number(value, digits=0):
    return '-' if value is None else f'{value:.{digits}f}'


def bounds(figures, clock):
    """ns a segment: what dispatch, four instructions a cycle, loads and wrong predictions take by themselves."""
    whole = figures.counts.whole
    cycles = [whole.instructions / rows.DISPATCHED, whole.instructions / 4, whole.loads / rows.LOADED,
              whole.mispredicted * rows.MISPREDICTED]
    return [count / clock for count in cycles]


def table_of_counts(measured):
    lines, counted = [], {kind for figures in measured for kind in figures.counts.by_kind}
    kinds = [*KINDS, *sorted(counted - set(KINDS))]  # none that the benchmark has is left out
    for figures in measured:
        counts, whole = figures.counts, figures.counts.whole
        lines.append([figures.row.scene, number(counts.segments_per_photon, 1), number(whole.instructions), number(whole.loads),
                      number(whole.stores), number(whole.mispredicted, 2), number(whole.code_misses, 2), number(counts.kernels.instructions),
                      *(number(counts.by_kind[kind].instructions if kind in counts.by_kind else 0) for kind in kinds)])
    return table(['scene', 'segments a photon', 'instructions', 'loads', 'stores', 'wrong predictions', 'code misses', 'kernels', *kinds], lines)


def has_kernels(counts):
    return counts.kernels.instructions >= FEW * counts.whole.instructions


EMISSION = ('emission', 'random', 'elementary')  # kinds, outside of kernels


def needed_share(figures):
    """Instructions over those that the factor leaves, were emission, look-ups and loops to cost nothing; None without a factor."""
    counts, left = figures.counts, instructions_left(figures)
    if left is None:
        return None
    outside = counts.whole.instructions - counts.kernels.instructions
    emission = sum(counts.by_kind[kind].instructions for kind in EMISSION if kind in counts.by_kind)
    return (counts.in_kernels[VECTORS] + outside - emission) / left


def table_of_kernels(measured):
    lines = []
    for figures in measured:
        counts = figures.counts
        if not has_kernels(counts):
            continue
        left = instructions_left(figures)
        outside = counts.whole.instructions - counts.kernels.instructions
        lines.append([figures.row.scene, number(counts.kernels.instructions),
                      *(number(counts.in_kernels[does]) for does in (VECTORS, SINGLE)),
                      number(None if left is None else max(0.0, left - outside)), number(needed_share(figures), 2)])
    return table(['scene', 'kernels', 'in vectors', 'one lane after another', 'left for kernels', 'needed'], lines)


def table_of_times(measured, clock):
    lines = []
    lanes = sorted({width for figures in measured for width in figures.nanoseconds})
    for figures in measured:
        ns = figures.nanoseconds
        rate = figures.counts.whole.instructions / ns[COUNTED_LANES]
        lines.append([figures.row.scene, *(number(ns.get(width), 1) for width in lanes), number(rate, 1), number(rate / clock, 2),
                      *(number(bound, 1) for bound in bounds(figures, clock))])
    return table(['scene', *(f'ns, {width} lanes' for width in lanes), 'instructions a ns', 'a cycle',
                  f'ns at {rows.DISPATCHED} instructions a cycle', 'at 4', f'ns at {rows.LOADED} loads a cycle',
                  'ns of wrong predictions'], lines)


def required_nanoseconds(figures, lanes=COUNTED_LANES):
    """Time a segment (ns) that the factor leaves; None without what it is a factor over."""
    if figures.row.of:
        return figures.of_nanoseconds[lanes] / figures.row.factor
    return figures.before.nanoseconds / figures.row.factor if figures.before else None


def instructions_left(figures):
    """Instructions a segment that the factor leaves, at as many a ns as before; over another scene, at as many as now."""
    if figures.row.of:
        return required_nanoseconds(figures) * figures.counts.whole.instructions / figures.nanoseconds[COUNTED_LANES]
    return figures.before.instructions / figures.row.factor if figures.before else None


def conclusion(figures):
    """What the instructions that the factor leaves would have to do."""
    required, left, counts = required_nanoseconds(figures), instructions_left(figures), figures.counts
    if required is None:
        return '-'
    if figures.nanoseconds[COUNTED_LANES] <= required:
        return 'met'
    outside = counts.whole.instructions - counts.kernels.instructions
    if counts.whole.instructions <= left:
        return 'few enough, at fewer a ns than before'
    if not has_kernels(counts):
        return f'no kernels; the ray query alone takes {counts.by_kind["ray query"].instructions / left:.2f} of them'
    if outside > left:
        return f'what is not in kernels takes {outside / left:.2f} of them'
    needed = counts.in_kernels[VECTORS]
    if needed > left - outside:
        return f'vectors alone take {needed / (left - outside):.2f} of what is left for kernels'
    return f'kernels in {left - outside:.0f} in place of {counts.kernels.instructions:.0f}'


def table_of_factors(measured):
    lines = []
    for figures in measured:
        row, ns, whole = figures.row, figures.nanoseconds, figures.counts.whole.instructions
        required = required_nanoseconds(figures)
        reached = []
        for lanes in sorted(ns):
            base = figures.of_nanoseconds[lanes] if row.of else figures.before and figures.before.nanoseconds
            reached.append(number(base / ns[lanes] if base else None, 2))
        lines.append([row.scene, f'{row.factor:g} x' + (f' {row.of}' if row.of else ''),
                      number(figures.before and figures.before.instructions), number(figures.before and figures.before.nanoseconds, 1),
                      *reached, number(required, 1), number(instructions_left(figures)), number(whole),
                      number(whole - figures.counts.kernels.instructions), conclusion(figures)])
    lanes = sorted(measured[0].nanoseconds) if measured else []
    return table(['scene', 'required', 'before: instructions', 'before: ns', *(f'reached, {width} lanes' for width in lanes),
                  'ns required', 'instructions left', 'instructions now', 'of them not in kernels', 'so'], lines)


def text_of(measured, machine, version):
    clock = machine['cycles_per_ns']
    return '\n'.join([
        f'{version}, {machine["cpu"]}, {clock:.2f} cycles a ns. All a segment, one thread; counts and rates of '
        f'{COUNTED_LANES} lanes.\n',
        table_of_counts(measured), table_of_kernels(measured), table_of_times(measured, clock),
        table_of_factors(measured)])
