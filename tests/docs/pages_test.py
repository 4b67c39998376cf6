"""Every command of the pages that a user follows is run, page by page in a folder of its own: blocks of sh line by line;
blocks of TOML whose first line is "# NAME.toml" are written as that file; cp takes an installed file. Photons and events
are few here."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ['SCINTRAY_SOURCE'])
PROGRAM = os.environ['SCINTRAY']
PAGES = ['docs/first_hour.md', *sorted(str(p.relative_to(SOURCE)) for p in SOURCE.glob('docs/howto/*.md'))]
INSTALLED = '/usr/share/scintray/'
MOST = {'--events': 60, '--photons': 3000, '--rays': 2000, '--paths': 20}
FEW_OF_MAP = ['--channel-photons', '2000']  # of a response map whose command leaves them open


def blocks(text):
    """(first line, language, content) of the blocks of a page."""
    for match in re.finditer(r'^```(\w+)\n(.*?)^```$', text, re.MULTILINE | re.DOTALL):
        yield text[:match.start()].count('\n') + 2, match.group(1), match.group(2)


def few(words):
    """The command with few photons and events."""
    result = list(words)
    for i, word in enumerate(words[:-1]):
        if word in MOST:
            result[i + 1] = str(min(int(words[i + 1]), MOST[word]))
    if words[:2] == ['response', 'build'] and FEW_OF_MAP[0] not in words:
        result += FEW_OF_MAP
    return result


class Pages(unittest.TestCase):
    def test_every_command_of_the_pages_runs(self):
        for page in PAGES:
            with tempfile.TemporaryDirectory() as folder:
                self.run_page(page, Path(folder))

    def run_page(self, page, folder):
        commands = 0
        for line, language, content in blocks((SOURCE / page).read_text()):
            if language == 'toml':
                name = re.match(r'# (\S+\.(?:toml|csv))\b', content)
                if name:
                    (folder / name.group(1)).write_text(content)
            if language == 'python':
                with self.subTest(page=page, line=line):
                    run = subprocess.run([sys.executable, '-c', content], cwd=folder, capture_output=True, text=True)
                    self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            if language != 'sh':
                continue
            for words in (shlex.split(one, comments=True) for one in content.replace('\\\n', ' ').splitlines()):
                if not words:
                    continue
                with self.subTest(page=page, line=line, command=' '.join(words)):
                    if words[0] == 'cp' and words[1].startswith(INSTALLED):
                        shutil.copy(SOURCE / words[1].removeprefix(INSTALLED), folder / words[2])
                        continue
                    self.assertEqual(words[0], 'scintray', 'a block of sh holds commands of scintray alone')
                    commands += 1
                    environment = {**os.environ, 'SCINTRAY_DATA': str(SOURCE)}
                    output = None
                    if '>' in words:
                        output = folder / words[words.index('>') + 1]
                        words = words[:words.index('>')]
                    run = subprocess.run([PROGRAM, *few(words[1:])], cwd=folder, capture_output=True, text=True,
                                         env=environment)
                    self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                    if output:
                        output.write_text(run.stdout)
        self.assertGreater(commands, 0, f'{page} has no command')


if __name__ == '__main__':
    unittest.main()
