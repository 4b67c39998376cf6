"""The types that the package states are those that a type checker (mypy) finds, of its users' code as well."""

import subprocess
import sys
import unittest

from support import SOURCE, Case, main

USER = '''
import scintray

scene: scintray.Scene = scintray.Scene.load("first.toml")
results: scintray.Results = scene.run()
share: float = results[0].detected.value
light: float = float(results.events().light.mean())
peak: float = results.analyze().photopeak.position.value
end: str = scintray.fit(scene).end
low: float = scintray.fit(scene).parameters["x"].low
index: float = float(scintray.Medium("LSO").index[0])
'''
WRONG = {'scintray.Medium("LSO").colour': 'has no attribute "colour"',
         'scintray.fit("x").chi': 'has no attribute "chi"',
         'scintray.open_results("x").events().ligth': 'has no attribute "ligth"',
         'scintray.open_results("x")[0].detcted': 'has no attribute "detcted"',
         'scintray.open_results("x")[0:1].detected': 'has no attribute "detected"',
         'scintray.HeightMap.synthesize(3)': 'incompatible type "int"'}


def check(*arguments, folder):
    return subprocess.run([sys.executable, '-m', 'mypy', '--ignore-missing-imports', '--cache-dir', folder / 'cache',
                           *arguments], check=False, text=True, capture_output=True, cwd=folder,
                          env={'MYPYPATH': str(SOURCE / 'src/scintray/python'), 'PATH': '/usr/bin:/bin'})


@unittest.skipUnless(subprocess.run([sys.executable, '-c', 'import mypy'], check=False, capture_output=True).returncode == 0,
                     'skipped: mypy is not installed')
class Types(Case):
    def test_the_package_and_its_users(self):
        done = check(SOURCE / 'src/scintray/python/scintray', folder=self.folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        (self.folder / 'user.py').write_text(USER)
        done = check('user.py', folder=self.folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_mistakes_of_users_are_found(self):
        lines = list(WRONG)
        (self.folder / 'user.py').write_text('import scintray\n\n' + '\n'.join(lines) + '\n')
        done = check('user.py', folder=self.folder)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        for number, line in enumerate(lines, 3):
            self.assertRegex(done.stdout, rf'user.py:{number}: .*' + WRONG[line])


if __name__ == '__main__':
    main()
