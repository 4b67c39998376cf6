"""What the benchmark's program measures and counts, through its lines of JSON (tools/benchmark/server.hpp)."""

import dataclasses
import json
import re
import subprocess
import tempfile
from pathlib import Path

import callgrind_file

# Counted is what this function does, in a file for each call of it.
TRACE = 'scintray::bench::Workload::trace(unsigned long, int) const'
CALLGRIND = ['valgrind', '--tool=callgrind', '--cache-sim=yes', '--branch-sim=yes']
# Functions of the kernels that propagate photons in lanes.
KERNEL = re.compile(r'\bLane(?:Passes|Propagation)<|\b(?:propagate|run)_lanes_(?:in_body_)?\d')


class Failed(Exception):
    """Why a program gave no figures."""


@dataclasses.dataclass
class Counts:
    """What was executed."""

    instructions: float = 0.0
    loads: float = 0.0
    stores: float = 0.0
    mispredicted: float = 0.0

    @classmethod
    def of(cls, events):
        return cls(events.get('Ir', 0), events.get('Dr', 0), events.get('Dw', 0), events.get('Bcm', 0) + events.get('Bim', 0))

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


class BenchProgram:
    def __init__(self, path):
        self.path = Path(path)
        self.version = ''  # once it has been timed

    def ask(self, requests, before=()):
        """The answers to requests. before: words in front of the command."""
        lines = ''.join(json.dumps(request) + '\n' for request in requests)
        done = subprocess.run([*before, str(self.path), '--serve'], input=lines, capture_output=True, text=True, check=False)
        answers = [json.loads(line) for line in done.stdout.splitlines()]
        for answer in answers:
            if 'error' in answer:
                raise Failed(answer['error'])
        if len(answers) != len(requests):
            raise Failed(f'{" ".join(before[:1]) or self.path.name} ended early: {done.stderr[-500:]}')
        return answers

    def machine(self):
        return self.ask([{'machine': True}])[0]

    def nanoseconds(self, scenes, lane_width, seconds):
        """Processor time a segment (ns) by scene, on one thread."""
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / 'figures.json'
            words = [word for scene in scenes for word in ('--scene', scene)]
            done = subprocess.run([str(self.path), *words, '--lane-width', str(lane_width), '--threads', '1', '--no-profile',
                                   '--seconds', str(seconds), '--json', str(output)],
                                  capture_output=True, text=True, check=False)
            if done.returncode != 0:
                raise Failed(done.stderr[-500:])
            figures = json.loads(output.read_text(encoding='utf-8'))
        self.version = f'ScintRay {figures["version"]}'
        return {scene['name']: 1e9 / scene['runs'][0]['segments_per_s']['median'] for scene in figures['scenes']}

    def counts(self, scene, lane_width, work):
        """Counts of a scene: the difference between 3 x work and work photons, or events, after as many that fill caches."""
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / 'counts'
            traced = self.ask([{'scene': scene, 'lane_width': lane_width, 'work': count, 'threads': 1}
                               for count in (work, work, 3 * work)],
                              [*CALLGRIND, f'--callgrind-out-file={output}', f'--toggle-collect={TRACE}', f'--dump-after={TRACE}'])
            less, more = (callgrind_file.read(f'{output}.{number}') for number in (2, 3))
        counted = callgrind_file.difference(more, less)
        segments = traced[2]['segments'] - traced[1]['segments']
        if segments == 0:
            raise Failed(f'{scene}: {3 * work} photons or events make no more segments than {work}')
        return self.attributed(counted, segments, segments / (traced[2]['photons'] - traced[1]['photons']))

    def attributed(self, counted, segments, segments_per_photon):
        places = list(counted)
        own = self.path.name
        kinds = self.ask([{'kinds_of': [['' if Path(place.object).name == own else Path(place.object).name,
                                         place.file, place.function] for place in places]}])[0]['kinds']
        result = SceneCounts(segments_per_photon, Counts(), Counts(), {})
        for place, kind in zip(places, kinds):
            counts = Counts.of(counted[place]) / segments
            result.whole += counts
            if KERNEL.search(place.function):
                result.kernels += counts
            else:
                result.by_kind[kind] = result.by_kind.get(kind, Counts()) + counts
        return result
