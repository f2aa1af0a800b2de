"""Under NumPy 2 the module gives right arrays, or its import fails with one clear line."""
import os
import subprocess
import sys
import unittest

import sample

NUMPY_2 = os.environ["FOVEA_INTEROP_NUMPY_2"]
PROGRAM = """
import sys
import numpy
assert numpy.__version__.startswith("2."), numpy.__version__
try:
    import fovea
except ImportError as error:
    sys.exit(f"ImportError: {error}")
points = fovea.Map(sys.argv[1]).points()
assert points.position.std(axis=0).min() > 0.1, "all points are the same"
"""


class NumpyTest(unittest.TestCase):
    def test_numpy_2(self):
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join([NUMPY_2, os.environ["PYTHONPATH"]]))
        run = subprocess.run([sys.executable, "-c", PROGRAM, sample.map_file()], env=environment, text=True,
                             stderr=subprocess.PIPE)
        if run.returncode != 0:
            self.assertRegex(run.stderr, r"^ImportError: [^\n]*NumPy 1[^\n]*\n$")


if __name__ == "__main__":
    unittest.main()
