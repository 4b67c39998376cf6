"""The figures of a run of scintray_bench."""

import json
import subprocess
import tempfile
from pathlib import Path


class Failed(Exception):
    """Why there are no figures."""


def figures_of(program, scenes, *options, started_by=()):
    """What `--json` of the benchmark has, for some scenes, without shares of time."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / 'figures.json'
        words = [word for scene in scenes for word in ('--scene', scene)]
        command = [*started_by, program, *words, '--no-profile', '--json', output, *options]
        try:
            done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        except OSError as error:
            raise Failed(f'{command[0]} cannot be started: {error.strerror}') from None
        if done.returncode != 0:
            raise Failed(done.stderr.strip().removeprefix('error: ')[-500:])
        return json.loads(output.read_text(encoding='utf-8'))
