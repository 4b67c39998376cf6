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


ROWS = [
    Row('polished', 4.0, 4096),
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
