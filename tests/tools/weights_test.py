"""tools/weights: light by weights is that without them, within their errors. Its gains are times, which are not tested."""

import subprocess
import sys
import unittest
from pathlib import Path

WEIGHTS = Path(__file__).resolve().parents[2] / 'tools/weights'
PROGRAM = sys.argv.pop()


class Weights(unittest.TestCase):
    def test_both_ways_have_the_same_light(self):
        printed = subprocess.run([sys.executable, str(WEIGHTS), '--quick', PROGRAM], capture_output=True, text=True, check=True)
        rows = [[cell.strip() for cell in line.strip('| ').split('|')] for line in printed.stdout.splitlines()[2:]]
        self.assertEqual(len(rows), 15)
        for title, plain, by_weight, difference, gain in rows:
            with self.subTest(title):
                self.assertLess(abs(float(difference)), 4.5, f'{plain}, {by_weight}')
                self.assertGreater(float(gain.split()[0]), 0.0)
        # One photon in 450,000, of which a run of 100,000 without weights has none.
        rarest = next(row for row in rows if '100 mm, traced with 5 times' in row[0])
        fraction, error = (float(number) for number in rarest[2].split(' ± '))
        self.assertLess(error, 0.2 * fraction)


if __name__ == '__main__':
    unittest.main()
