"""The scenes whose limits are stated, what is required of them, and what a processor can do at most."""

import dataclasses


@dataclasses.dataclass
class Row:
    """A scene of the benchmark.

    factor  required, over the segments/s of version 0.1; with `of`: over those of that scene
    work    photons, or events, of the smaller of two counts: some hundred thousand segments between them
    """

    scene: str
    factor: float
    work: int
    of: str = ''
    chained: bool = False  # each segment waits for the one before, in the kernel for total reflections


ROWS = [
    Row('polished', 4.0, 4096, chained=True),
    Row('unified', 4.0, 16384),
    Row('table', 4.0, 16384),
    Row('painted', 3.0, 4096),
    Row('table_ptfe', 3.0, 4096),
    Row('polished_3072', 1.5, 3072),
    Row('block', 2.5, 4096),
    Row('array_20_wrapped', 2.5, 2048),
    Row('array_40_bare', 0.8, 2048, of='array_1_bare'),
    Row('gamma_array', 2.5, 8),
]

# Zen 4, by LLVM's model of it (llvm/lib/Target/X86/X86ScheduleZnver4.td of llvm/llvm-project), which names AMD's
# Software Optimization Guide 57647: macro-ops dispatched and floating-point loads in a cycle, cycles that a wrong
# prediction commonly costs. Assumed: that an instruction is one macro-op.
DISPATCHED, LOADED, MISPREDICTED = 6, 2, 13

# The longest chain from one segment's end to the next one's, in the kernel for total reflections in a box
# (lane_box_set.hpp), with the cycles of its instructions by the same source; comparisons are those of minima and
# maxima, too. Two vectors take turns, so that a processor works on two such chains at a time.
ADD, MULTIPLY, COMPARE, BLEND, STORE, LOAD = 3, 3, 2, 1, 1, 8
VECTORS_IN_TURNS = 2


def chain():
    """(what, cycles) of the chain, for all lanes of a vector together."""
    return [('the position out of memory', LOAD),
            ('its distance from the faces across an axis', 2 * ADD),
            ('that of the face ahead', BLEND + COMPARE),
            ('times the inverse cosine', MULTIPLY),
            ('the least of three', 3 * COMPARE),
            ('the next position', MULTIPLY + ADD),
            ('into memory', STORE)]
