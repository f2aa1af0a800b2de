"""The examples of docs/python.md and docs/live.md run, and they and the stubs are typed."""
import os
import pathlib
import subprocess
import sys
import unittest

import fovea
import numpy as np

import live_sample
import sample

ROOT = pathlib.Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
PACKAGES = pathlib.Path(fovea.__file__).parents[1]


def run_python(*arguments):
    environment = {**os.environ, "PYTHONPATH": str(PACKAGES), "MYPYPATH": str(PACKAGES)}
    return subprocess.run([sys.executable, *map(str, arguments)], env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


class ExamplesTest(unittest.TestCase):
    def expect(self, run, *texts):
        self.assertEqual(run.returncode, 0, run.stdout)
        for text in texts:
            self.assertIn(text, run.stdout)

    def test_the_page_shows_them(self):
        pages = "".join((ROOT / "docs" / page).read_text() for page in ("python.md", "live.md"))
        for example in EXAMPLES.glob("*.py"):
            code = example.read_text().split('"""\n', 1)[1].strip()
            self.assertIn(code, pages, example)

    def test_read_map(self):
        self.expect(run_python(EXAMPLES / "read_map.py", sample.map_file()), "points from",
                    "mean color")

    def test_draw_map(self):
        picture = sample.folder() / "top.ppm"
        self.expect(run_python(EXAMPLES / "draw_map.py", sample.map_file(), picture), "points on")
        kind, width, height, _ = picture.read_bytes().split(maxsplit=3)
        self.assertEqual(kind, b"P6")
        pixels = np.frombuffer(picture.read_bytes()[-int(width) * int(height) * 3:], np.uint8)
        self.assertGreater(np.count_nonzero(pixels), 1000)

    def test_map_and_evaluate(self):
        self.expect(run_python(EXAMPLES / "map_and_evaluate.py", sample.drive(),
                               sample.folder() / "example.fovea"), "held-out", "TE")

    def test_localize(self):
        self.expect(run_python(EXAMPLES / "localize.py", sample.drive(), sample.map_file()),
                    "health", "is skipped")

    def test_live_mapping(self):
        output = sample.folder() / "live_example.fovea"
        self.expect(run_python(EXAMPLES / "live_mapping.py", live_sample.simulated(), output),
                    "0 tracked", "points", "'scans': 14")
        made = fovea.Map(output)
        self.assertGreater(made.size, 1000)
        # The machine may be slow: the example lets late data go.
        self.assertGreaterEqual(len(made.frames), live_sample.FRAMES // 2)
        for frame in made.frames:
            apart = frame.T_local_lidar[:3, 3] - frame.T_local_lidar_navigation[:3, 3]
            self.assertLess(np.linalg.norm(apart), 1)

    def test_register_scans(self):
        self.expect(run_python(EXAMPLES / "register_scans.py", sample.drive(), 0, 1), "moved 0.")

    def test_paper_by_hand(self):
        self.expect(run_python(EXAMPLES / "paper_by_hand.py", sample.drive(), 1),
                    "in the foveal region", "mean color")

    def test_color_cloud(self):
        output = sample.folder() / "colored.txt"
        self.expect(run_python(EXAMPLES / "color_cloud.py", sample.drive(), 1, output),
                    "points have a color")
        colored = np.loadtxt(output)
        self.assertEqual(colored.shape[1], 6)
        self.assertGreater(len(colored), 1000)
        self.assertGreater(colored[:, 3:].std(), 5)

    def test_types(self):
        cache = sample.folder() / "mypy"
        self.expect(run_python("-m", "mypy", "--strict", "--cache-dir", cache,
                               *sorted(EXAMPLES.glob("*.py"))))
        config = sample.folder() / "mypy.ini"
        config.write_text(f"[mypy]\ncache_dir = {cache}\n")
        self.expect(run_python("-m", "mypy.stubtest", "fovea", "--mypy-config-file", config,
                               "--allowlist", pathlib.Path(__file__).with_name("stubtest.txt")))


if __name__ == "__main__":
    unittest.main()
