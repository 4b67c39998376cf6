"""Every block of docs/python.md runs, one after the other; the example too, with fewer events."""

import ast
import json
import os
import re

import matplotlib.pyplot as plt

import scintray
from support import SOURCE, Case, main


def blocks(page):
    """(first line, content) of the Python blocks of a page."""
    text = page.read_text()
    for match in re.finditer(r'^```python\n(.*?)^```$', text, re.MULTILINE | re.DOTALL):
        yield text[:match.start()].count('\n') + 2, match.group(1)


class Pages(Case):
    def in_folder(self):
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)

    def test_every_block_of_the_page_runs(self):
        page = SOURCE / 'docs/python.md'
        self.assertEqual(len(re.findall(r'^```', page.read_text(), re.MULTILINE)), 2 * len(list(blocks(page))))
        self.in_folder()
        names = {}
        for line, content in blocks(page):
            with self.subTest(line=line):
                exec(compile('\n' * (line - 1) + content, str(page), 'exec'), names)
        for picture in ('arrival.png', 'analysis.png', 'goniometer.png', 'fit.png'):
            self.assertGreater((self.folder / picture).stat().st_size, 5000)
        plt.close('all')

    def test_the_page_names_every_public_name(self):
        text = (SOURCE / 'docs/python.md').read_text()
        inner = {'Analysis', 'Estimate', 'Events', 'Fit', 'Goniometer', 'Point', 'Problem', 'ProgressBar', 'Results',
                 'SurfaceTable', 'Tally', 'errors', 'media', 'names'}  # what others return, or lists of names
        for name in set(scintray.__all__) - inner:
            self.assertRegex(text, rf'\b{name}\b')
        for name in scintray.__all__:
            self.assertTrue(getattr(scintray, name).__doc__, name)

    def test_the_stubs_are_those_of_the_library(self):
        import scintray._core as core
        tree = ast.parse((SOURCE / 'src/scintray/python/scintray/_core.pyi').read_text())
        functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
        classes = {node.name: {inner.name for inner in node.body} for node in tree.body
                   if isinstance(node, ast.ClassDef)}
        real = {name for name in dir(core) if not name.startswith('_')}
        self.assertEqual(functions | set(classes), real)
        for name, methods in classes.items():
            public = {method for method in dir(getattr(core, name)) if not method.startswith('_')}
            self.assertEqual(methods - {'__init__'}, public, name)

    def test_the_example_runs(self):
        source = (SOURCE / 'docs/examples/lyso_array.py').read_text()
        short = source.replace('photons_per_cell=10_000', 'photons_per_cell=100, photons_per_channel=2000') \
            .replace('events=40_000', 'events=3000')
        self.assertEqual(source.count('photons_per_cell=10_000') + source.count('events=40_000'), 2)
        self.in_folder()
        names = {}
        exec(compile(short, 'lyso_array.py', 'exec'), names)
        self.assertEqual(len(names['results'].events().channels['name']), 64)
        analysis = names['analysis']
        for part in (analysis.flood, analysis.spectrum, analysis.light_against_depth, analysis.ctr):
            self.assertIsNotNone(part)
        plt.close('all')

    def test_the_notebook_is_the_example_with_its_output(self):
        source = (SOURCE / 'docs/examples/lyso_array.py').read_text()
        cells = [part.partition('\n') for part in re.split(r'^# %%', source, flags=re.MULTILINE)[1:]]
        expected = [body.strip() for head, _, body in cells if 'markdown' not in head]
        notebook = json.loads((SOURCE / 'docs/examples/lyso_array.ipynb').read_text())
        code = [cell for cell in notebook['cells'] if cell['cell_type'] == 'code']
        self.assertEqual([''.join(cell['source']) for cell in code], expected)
        pictures = [output for cell in code for output in cell['outputs'] if 'image/png' in output.get('data', {})]
        self.assertEqual(len(pictures), 2)


if __name__ == '__main__':
    main()
