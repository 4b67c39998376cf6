"""The JSON schema that the program prints, by an independent validator (python3-jsonschema): it accepts every scene that
the program reads, and refuses those of the mistakes that a schema can see."""

import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

try:
    import jsonschema
    import tomllib
except ImportError as missing:
    print(f'[skipped] {missing}')
    sys.exit(77)

SOURCE = Path(os.environ['SCINTRAY_SOURCE'])
PROGRAM = os.environ['SCINTRAY']

# Mistakes that no schema can see: of syntax, of names and places, of numbers whose limits depend on others.
BEYOND_A_SCHEMA = 45


def schema():
    text = subprocess.run([PROGRAM, 'schema'], check=True, capture_output=True, text=True).stdout
    return json.loads(text)


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = schema()
        jsonschema.Draft202012Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft202012Validator(cls.schema)

    def errors(self, path):
        return [f'{"/".join(map(str, error.absolute_path))}: {error.message[:200]}'
                for error in self.validator.iter_errors(tomllib.loads(path.read_text()))]

    def test_every_scene_is_accepted(self):
        scenes = [*SOURCE.glob('scenes/**/*.toml'), *SOURCE.glob('tools/benchmark/scenes/*.toml')]
        self.assertGreater(len(scenes), 15)
        for scene in scenes:
            with self.subTest(scene=str(scene)):
                self.assertEqual(self.errors(scene), [])

    def test_mistakes_that_a_schema_can_see_are_refused(self):
        refused, accepted = [], []
        for path in sorted(SOURCE.glob('tests/bad_input/mistakes/*.toml')):
            try:
                errors = self.errors(path)
            except (tomllib.TOMLDecodeError, UnicodeDecodeError):
                continue  # the syntax of TOML, of which editors have their own check
            (refused if errors else accepted).append(path.stem)
        names = ' '.join(refused)
        for one in ('01_no_unit', '02_wrong_unit', '03_misspelt_key', '15_bad_side_word', '24_two_shapes',
                    '36_type_photon_singular', '92_a_quantity'):
            if list(SOURCE.glob(f'tests/bad_input/mistakes/{one}*')):
                self.assertTrue(one in names or one not in ' '.join(accepted), one)
        self.assertGreater(len(refused), 30, accepted)
        self.assertLess(len(accepted), BEYOND_A_SCHEMA, accepted)

    def test_the_page_of_keys_names_every_key_of_the_schema(self):
        page = subprocess.run([PROGRAM, 'schema', '--reference'], check=True, capture_output=True, text=True).stdout
        for key in ('sigma_alpha', 'slab_z', 'photons_per_event', 'microcells', 'reciprocal'):
            if f'"{key}"' in json.dumps(self.schema):
                self.assertIn(f'`{key}`', page)


if __name__ == '__main__':
    unittest.main()
