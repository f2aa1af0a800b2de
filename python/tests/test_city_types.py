"""The types of fovea.city."""
import pathlib
import unittest

import fovea

import sample
from test_examples import run_python


class TypesTest(unittest.TestCase):
    def test_types(self):
        package = pathlib.Path(fovea.__file__).parent / "city"
        run = run_python("-m", "mypy", "--strict", "--cache-dir", sample.folder() / "mypy", "-p", "fovea.city")
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertIn(f"in {len(list(package.glob('*.py')))} source files", run.stdout)


if __name__ == "__main__":
    unittest.main()
