"""Links of the pages lead somewhere: to files of the repository, and to headings of them."""

import os
import re
import unittest
from pathlib import Path

SOURCE = Path(os.environ['SCINTRAY_SOURCE']).resolve()
LINK = re.compile(r'\]\(([^()\s]+)\)')
FENCE = re.compile(r'^```.*?^```', re.MULTILINE | re.DOTALL)
# Pages that tools/docs writes.
GENERATED = {f'{one}.md' for one in ('keys', 'commands', 'error_codes', 'gallery', 'python_reference', 'cpp_reference',
                                    'changelog')}


def pages():
    """Every page of Markdown that is part of the project, without templates (*.in.md) and what tools/docs puts elsewhere."""
    found = [page for folder in ('docs', 'examples', 'scenes', 'packaging', 'tests', 'tools', 'materials')
             for page in (SOURCE / folder).rglob('*.md')]
    own = [page for page in found if not page.name.endswith('.in.md') and page.parent.name != 'site']
    return sorted({*SOURCE.glob('*.md'), *own})


def headings(page):
    """The anchors of a page's headings, as GitHub and MyST make them of their words."""
    text = FENCE.sub('', page.read_text())
    words = re.findall(r'^#+\s+(.*?)\s*$', text, re.MULTILINE)
    return {re.sub(r'[^\w\- ]', '', one.lower()).replace(' ', '-') for one in words}


class Links(unittest.TestCase):
    def test_links_lead_to_files_and_headings(self):
        broken, count = [], 0
        for page in pages():
            for link in LINK.findall(FENCE.sub('', page.read_text())):
                if re.match(r'[a-z]+:', link):
                    continue
                count += 1
                target, _, anchor = link.partition('#')
                there = (page.parent / target).resolve() if target else page
                if there.parent == SOURCE / 'docs' and there.name in GENERATED:
                    continue
                if not there.exists():
                    broken.append(f'{page.relative_to(SOURCE)}: no file {link}')
                elif anchor and there.suffix == '.md' and anchor not in headings(there):
                    broken.append(f'{page.relative_to(SOURCE)}: no heading {link}')
        self.assertEqual(broken, [])
        self.assertGreater(count, 100)


if __name__ == '__main__':
    unittest.main()
