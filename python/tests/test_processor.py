"""`import fovea` on a processor that cannot run the module."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import fovea
from fovea._processor import missing_feature

PROCESSOR = "processor\t: 0\nflags\t\t: fpu avx fma\n\nprocessor\t: 1\nflags\t\t: fpu avx fma\n"


class ProcessorTest(unittest.TestCase):
    def test_missing_features(self):
        self.assertIsNone(missing_feature(["fma", "avx"], PROCESSOR))
        self.assertEqual(missing_feature(["fma", "avx2"], PROCESSOR), "avx2")
        self.assertIsNone(missing_feature(["avx2"], "Features : asimd\n"))

    def test_the_import_fails_with_one_line(self):
        package = pathlib.Path(fovea.__file__).parent
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder, "fovea")
            copy.mkdir()
            for name in ("__init__.py", "_processor.py"):
                shutil.copy(package / name, copy)
            copy.joinpath("processor.txt").write_text("no_such_feature\n")
            run = subprocess.run([sys.executable, "-c", "import fovea"], env={"PYTHONPATH": folder},
                                 capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, r"\nImportError: fovea: the processor lacks no_such_feature, .*\n$")


if __name__ == "__main__":
    unittest.main()
