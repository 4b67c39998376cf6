"""Reads a file of `valgrind --tool=callgrind`: what each place of a program counted itself, without what it calls."""

from pathlib import Path
from typing import NamedTuple

NAMES = {'ob': 'object', 'fl': 'file', 'fi': 'file', 'fe': 'file', 'fn': 'function'}
# Of the callee of a call: named for the compression of names, else without use here.
CALLED = {'cob': 'object', 'cfi': 'file', 'cfl': 'file', 'cfn': 'function'}


class Place(NamedTuple):
    """The object, the source file of a line, inlined or not, and the function that it is compiled into."""

    object: str
    file: str
    function: str


class Names:
    """Names that the file gives once, as "(7) name", and later as "(7)"."""

    def __init__(self):
        self.known = {'object': {}, 'file': {}, 'function': {}}

    def name_of(self, kind, text):
        if not text.startswith('('):
            return text
        number, _, name = text.partition(') ')
        if name:
            self.known[kind][number] = name
        else:
            number = number.rstrip(')')
        return self.known[kind][number]


def read(path):
    """The counts by place: {Place: {event: count}}."""
    events, names, counted = [], Names(), {}
    now = {'object': '', 'file': '', 'function': ''}
    called = False
    for line in Path(path).read_text(encoding='utf-8', errors='replace').splitlines():
        if line.startswith('events:'):
            events = line.split()[1:]
        elif line[:1].isdigit() or line[:1] in ('+', '-', '*'):
            if called:  # what the callee counted
                called = False
                continue
            counts = counted.setdefault(Place(now['object'], now['file'], now['function']), [0] * len(events))
            for i, count in enumerate(line.split()[1:]):
                counts[i] += int(count)
        else:
            word, _, text = line.partition('=')
            if word in NAMES:
                now[NAMES[word]] = names.name_of(NAMES[word], text)
            elif word in CALLED:
                names.name_of(CALLED[word], text)
            elif word == 'calls':
                called = True
    return {place: dict(zip(events, counts)) for place, counts in counted.items()}


def difference(more, less):
    """Counts of one file less those of another; places without a difference are left out."""
    result = {}
    for place in more.keys() | less.keys():
        a, b = more.get(place, {}), less.get(place, {})
        counts = {event: a.get(event, 0) - b.get(event, 0) for event in a.keys() | b.keys()}
        if any(counts.values()):
            result[place] = counts
    return result
