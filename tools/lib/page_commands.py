#!/usr/bin/python3
"""tools/lib/page_commands.py PAGE: prints, for sh, what a page of the documentation has its reader type and write: its
blocks of sh without installing packages, each command timed, and those of TOML whose first line is "# NAME.toml" as
that file."""

import re
import shlex
import sys
from pathlib import Path

print('set -e')
for language, content in re.findall(r'^```(\w+)\n(.*?)^```$', Path(sys.argv[1]).read_text(), re.MULTILINE | re.DOTALL):
    name = re.match(r'# (\S+\.toml)\b', content)
    if language == 'toml' and name:
        print(f"cat >{name.group(1)} <<'END'\n{content}END")
    elif language == 'sh':
        for command in content.replace('\\\n', ' ').splitlines():
            if command and not command.startswith(('#', 'apt ')):
                print(f'begin=$(date +%s)\n{{ {command}; }} >>log 2>&1\n'
                      f'printf "%5s s  %s\\n" $(($(date +%s) - begin)) {shlex.quote(command)}')
