"""What the benchmark's program measures and counts, through its lines of JSON (tools/benchmark/server.hpp)."""

import dataclasses
import json
import re
import subprocess
import tempfile
from pathlib import Path

import callgrind_file
from bench_figures import Failed, figures_of

# Counted is what this function does, in a file for each call of it; callgrind wants it with its parameters.
TRACE = re.compile(r' T (scintray::bench::Workload::trace\(.*\) const)$', re.MULTILINE)
CALLGRIND = ['valgrind', '--tool=callgrind', '--cache-sim=yes', '--branch-sim=yes']
FIRST_COUNTED = 2  # file of the first trace that is compared: those before it fill caches
# Functions of the kernels that propagate photons in lanes.
KERNEL = re.compile(r'\bLane(?:Passes|Photons|Propagation|sInBox)<|\b(?:propagate|refract|run)_lanes_(?:in_body_)?\d')
# What an instruction in a kernel does, by the source file of its line; all else is done for one lane after another.
VECTORS, SINGLE = 'vectors', 'one lane'
IN_VECTORS = re.compile(r'intrin\.h$|/xsimd/|/lane_number\.hpp$')


@dataclasses.dataclass
class Counts:
    """What was executed."""

    instructions: float = 0.0
    loads: float = 0.0
    stores: float = 0.0
    mispredicted: float = 0.0
    code_misses: float = 0.0  # lines of code that were not in the first-level cache

    @classmethod
    def of(cls, events):
        return cls(events.get('Ir', 0), events.get('Dr', 0), events.get('Dw', 0), events.get('Bcm', 0) + events.get('Bim', 0),
                   events.get('I1mr', 0))

    def __add__(self, other):
        return Counts(*(a + b for a, b in zip(dataclasses.astuple(self), dataclasses.astuple(other))))

    def __truediv__(self, number):
        return Counts(*(a / number for a in dataclasses.astuple(self)))


@dataclasses.dataclass
class SceneCounts:
    """Counts a segment."""

    segments_per_photon: float
    whole: Counts
    kernels: Counts
    by_kind: dict  # of what is not in the kernels
    in_kernels: dict  # instructions of the kernels by what they do

    @classmethod
    def of_plain(cls, plain):
        """From what dataclasses.asdict makes of it."""
        by_kind = {kind: Counts(**counts) for kind, counts in plain['by_kind'].items()}
        return cls(plain['segments_per_photon'], Counts(**plain['whole']), Counts(**plain['kernels']), by_kind, plain['in_kernels'])


class Conversation:
    """Requests to a server and its answers, one after the other."""

    def __init__(self, command):
        self.name = Path(command[0]).name
        self.errors = tempfile.TemporaryFile('w+')
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.errors.close()

    def answer(self, request):
        self.process.stdin.write(json.dumps(request) + '\n')
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            self.errors.seek(0)
            raise Failed(f'{self.name} ended before its answer: {self.errors.read()[-500:]}')
        answer = json.loads(line)
        if 'error' in answer:
            raise Failed(answer['error'])
        return answer


def count_later(program):
    """Building a scene is not counted, which is many times faster so, and processes that read its tables keep to their limits."""
    symbols = subprocess.run(['nm', '-C', str(program)], capture_output=True, text=True, check=True).stdout
    found = TRACE.search(symbols)
    if not found:
        raise Failed(f'{program} has no function that traces a workload, of which callgrind could count the work')
    return ['--instr-atstart=no', f'--toggle-collect={found[1]}', f'--dump-after={found[1]}']


class BenchProgram:
    def __init__(self, path):
        self.path = Path(path)
        self.version = ''  # once it has been timed

    def ask(self, request):
        with Conversation([str(self.path), '--serve']) as talk:
            return talk.answer(request)

    def machine(self):
        return self.ask({'machine': True})

    def nanoseconds(self, scenes, lane_width, seconds):
        """Processor time a segment (ns) by scene, on one thread."""
        figures = figures_of(self.path, scenes, '--lane-width', lane_width, '--threads', 1, '--seconds', seconds)
        self.version = f'ScintRay {figures["version"]}'
        return {scene['name']: 1e9 / scene['runs'][0]['segments_per_s']['median'] for scene in figures['scenes']}

    def counts(self, scene, lane_width, work):
        """Counts of a scene: the difference between 3 x work and work photons, or events, after as many that fill caches."""
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / 'counts'
            with Conversation([*CALLGRIND, *count_later(self.path), f'--callgrind-out-file={output}', str(self.path), '--serve']) as talk:
                def trace(photons):
                    return talk.answer({'scene': scene, 'lane_width': lane_width, 'work': photons, 'threads': 1})
                trace(work)
                subprocess.run(['callgrind_control', '--instr=on', str(talk.process.pid)], capture_output=True, check=True)
                _, less, more = (trace(count) for count in (work, work, 3 * work))
            if not Path(f'{output}.{FIRST_COUNTED + 1}').exists() or Path(f'{output}.{FIRST_COUNTED + 2}').exists():
                raise Failed('valgrind wrote another number of counts than there were traces')
            counts_less, counts_more = (callgrind_file.read(f'{output}.{number}') for number in (FIRST_COUNTED, FIRST_COUNTED + 1))
        counted = callgrind_file.difference(counts_more, counts_less)
        segments = more['segments'] - less['segments']
        if segments == 0:
            raise Failed(f'{scene}: {3 * work} photons or events make no more segments than {work}')
        return self.attributed(counted, segments, segments / (more['photons'] - less['photons']))

    def attributed(self, counted, segments, segments_per_photon):
        places = list(counted)
        own = self.path.name
        kinds = self.ask({'kinds_of': [['' if Path(place.object).name == own else Path(place.object).name,
                                         place.file, place.function] for place in places]})['kinds']
        result = SceneCounts(segments_per_photon, Counts(), Counts(), {}, dict.fromkeys((VECTORS, SINGLE), 0.0))
        for place, kind in zip(places, kinds):
            counts = Counts.of(counted[place]) / segments
            result.whole += counts
            if KERNEL.search(place.function):
                result.kernels += counts
                result.in_kernels[VECTORS if IN_VECTORS.search(place.file) else SINGLE] += counts.instructions
            else:
                result.by_kind[kind] = result.by_kind.get(kind, Counts()) + counts
        return result
