"""tools/structure on made-up trees, in the layout with and without src/scintray/."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / 'tools'
sys.dont_write_bytecode = True
sys.path.insert(0, str(TOOLS / 'lib'))
from cpp_functions import functions  # noqa: E402

DEFINITIONS = r'''
[surface_model]
model = "DULL"
pattern = '(?i)dull'
other_programs = ["io"]
[[photon]]
stage = "step"
patterns = ['\bvoid step\([^;{]*\{']
[[photon]]
stage = "scatter"
formula = true
patterns = ['\bDull::scatter\([^;{]*\{']
'''

FILES = {
    'core/CMakeLists.txt': 'add(core a.cpp)\n',
    'core/a.hpp': '#pragma once\nnamespace ray::core {\nint a(bool x, bool y);\n}\n',
    'core/a.cpp': '#include "scintray/core/a.hpp"\n'
                  'namespace ray::core {\nnamespace {\n'
                  '// a == "comment_word" is a comparison in a comment, and counts as the lines do\n'
                  'bool is(const char* s) { return s == "word" || s == "other"; }\n}\n'
                  'int a(bool x, bool y) { return x + y; }\n}\n',
    'core/detail/b.hpp': 'namespace ray { struct B {}; }\n',
    'core/b.cpp': '#include "scintray/core/detail/b.hpp"\n',
    'optics/dull.hpp': '#include "scintray/core/a.hpp"\nnamespace ray {\nstruct Dull { void scatter(); };\n}\n',
    'optics/dull.cpp': '#include "scintray/optics/dull.hpp"\nnamespace ray {\n'
                       'void Dull::scatter() {}\n// void step() {\n}\n',
    'optics/walk.cpp': '#include "scintray/optics/dull.hpp"\n#include "scintray/core/detail/b.hpp"\n'
                       'void step(int a, int b, int c, int d, int e, int f, int g) {\n'
                       + '  ++a;\n' * 400 + '}\n',
    'io/export.cpp': '#include "scintray/core/a.hpp"\nconst char* kind = "dull";\n',
}

EXPECTED = {
    'files': 8,
    'lines': 4 + 8 + 1 + 1 + 4 + 5 + 404 + 2,
    'median lines a file': 4,
    'modules': 3,
    'largest module, % of lines': round(100 * 413 / 429, 1),
    'headers': 3,
    'headers in detail/': 1,
    'headers with one user': 2,  # b, whose own b.cpp is above detail/, and dull; a has two
    'headers without a user': 0,
    'namespaces': 2,
    'string comparisons of words': 2,
    'files over 400 lines': 1,
    'functions with over 6 parameters': 1,
    'functions with two or more flags': 1,
    'files that name a surface model': 4,
    'of them, not for other programs': 3,
    'files that follow one photon': 2,
    'of them, without formulas': 1,
}


class StructureTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        self.definitions = self.root / 'definitions.toml'
        self.definitions.write_text(DEFINITIONS)

    def write(self, files, base):
        for name, text in files.items():
            path = self.root / base / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    def run_tool(self, *options):
        return subprocess.run([TOOLS / 'structure', '--root', self.root, '--definitions', self.definitions, *options],
                              capture_output=True, text=True)

    def git(self, *words):
        subprocess.run(['git', '-C', self.root, '-c', 'user.name=a', '-c', 'user.email=a@example.org', *words],
                       check=True, capture_output=True)

    def test_counts_are_the_same_in_both_layouts(self):
        for base in ('src', 'src/scintray'):
            with self.subTest(base):
                self.write(FILES, base)
                done = self.run_tool('--json')
                self.assertEqual((done.returncode, done.stderr), (0, ''))
                self.assertEqual(json.loads(done.stdout)['now']['numbers'], EXPECTED)
                for path in sorted((self.root / 'src').rglob('*'), reverse=True):
                    path.rmdir() if path.is_dir() else path.unlink()

    def test_lists_name_what_was_counted(self):
        self.write(FILES, 'src')
        lists = json.loads(self.run_tool('--json').stdout)['now']['lists']
        self.assertEqual(lists['headers with one user'], ['core/detail/b.hpp', 'optics/dull.hpp'])
        self.assertEqual(lists['functions with two or more flags'], ['core: a, 2 parameters, 2 flags'])
        self.assertEqual(lists['way of a photon'], {'step': ['optics/walk'], 'scatter': ['optics/dull']})

    def test_a_stage_that_is_not_found_is_an_error(self):
        self.write({**FILES, 'optics/walk.cpp': 'int nothing();\n'}, 'src')
        done = self.run_tool()
        self.assertEqual(done.returncode, 1)
        self.assertIn('"step"', done.stderr)

    def test_a_revision_stands_beside_the_checkout(self):
        self.write({'core/a.hpp': 'int a();\n', **{k: v for k, v in FILES.items() if 'optics' in k}}, 'src')
        self.git('init', '-q')
        self.git('add', 'src')
        self.git('commit', '-q', '-m', 'first')
        self.write(FILES, 'src')
        done = self.run_tool('--compare', 'HEAD')
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        rows = [line.split() for line in done.stdout.splitlines()]
        self.assertEqual(rows[0], ['HEAD', 'now'])
        self.assertIn(['files', '4', '8'], rows)
        self.assertEqual(self.run_tool('--compare', 'no_such_revision').returncode, 2)


class FunctionsTest(unittest.TestCase):
    def heads(self, text):
        return [(f.name, len(f.parameters), f.flags) for f in functions(text)]

    def test_heads_with_brackets_in_them(self):
        self.assertEqual(self.heads('''
            #define NOT(a, b) a(b)
            namespace n {
            std::map<int, int> f(std::map<int, bool> m = {{1, true}}, bool flag = g(1, 2), const bool other = 0);
            class C : public B<int> {
             public:
              explicit C(int a, bool& out) : a_{a}, out_(out) { call(1, 2, 3); if (a) { return; } }
              bool operator()(int x) const { return x; }
              std::function<void(bool, bool)> hook;
              int a_ = value(1, 2);
            };
            /* int gone(bool a, bool b); */
            const char* text() { return "int no(bool a, bool b); {"; }
            char brace() { return '{'; }
            long big(int a) { return 1'000'000 + a; }
            }
            '''), [('f', 3, 2), ('C', 2, 0), ('operator', 1, 0), ('text', 0, 0), ('brace', 0, 0), ('big', 1, 0)])


if __name__ == '__main__':
    unittest.main()
