"""fovea.laz and Map.plot_top(): with their packages, and without."""
import importlib.util
import sys
import unittest
from unittest import mock

import fovea
import fovea.laz
import numpy as np
from fovea import _copc, _plot

import sample
from test_examples import run_python


def needs(*modules):
    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    return unittest.skipIf(missing, f"not installed: {', '.join(missing)}")


def las_records():
    """The point records of the program's LAS file."""
    output = sample.folder() / "extras.las"
    sample.run("export", sample.map_file(), output, "--force", "--quiet", "--uncolored",
               "--exposure", "auto")
    content = output.read_bytes()
    start, = np.frombuffer(content, "<u4", 1, 96)
    kinds = [("X", "<i4"), ("Y", "<i4"), ("Z", "<i4"), ("intensity", "<u2"), ("returns", "u1"),
             ("flags", "u1"), ("classification", "u1"), ("user", "u1"), ("angle", "<i2"),
             ("source", "<u2"), ("gps_time", "<f8"), ("red", "<u2"), ("green", "<u2"),
             ("blue", "<u2"), ("camera", "i1"), ("frame", "<i4"), ("range", "<f4"),
             ("interpolated", "u1"), ("views", "u1"), ("spread", "u1"), ("reason", "u1")]
    return np.frombuffer(content, kinds, offset=int(start))


class MissingPackagesTest(unittest.TestCase):
    def test_the_error_names_the_packages(self):
        opened = fovea.Map(sample.map_file())
        for module, packages, use in [
                ("laspy", '"laspy[lazrs]" copclib',
                 lambda: fovea.laz.write(opened, sample.folder() / "no.laz")),
                ("copclib", '"laspy[lazrs]" copclib',
                 lambda: fovea.laz.write(opened, sample.folder() / "no.copc.laz")),
                ("matplotlib.pyplot", "matplotlib", opened.plot_top)]:
            with mock.patch.dict(sys.modules, {module: None, "laspy": None}):
                with self.assertRaises(ImportError) as caught:
                    use()
            self.assertIn(f"pip install {packages}", str(caught.exception))
        self.assertEqual(list(sample.folder().glob("*no.*laz*")), [])

    def test_import_fovea_does_not_need_them(self):
        run = "import sys, fovea; assert not {'laspy', 'copclib', 'matplotlib'} & set(sys.modules)"
        done = run_python("-c", run)
        self.assertEqual(done.returncode, 0, done.stdout)


class NumpyTest(unittest.TestCase):
    def test_another_numpy_than_the_module_reads_is_an_import_error(self):
        done = run_python("-c", "import numpy; numpy.__version__ = '2.1.0'; import fovea")
        if done.returncode == 0:
            self.skipTest("this build reads NumPy 2")
        self.assertIn("ImportError: this build of fovea needs NumPy 1, not 2.1.0", done.stdout)


class ColumnsTest(unittest.TestCase):
    def test_columns_are_those_of_the_export(self):
        points = fovea.Map(sample.map_file()).points()
        records = las_records()
        columns = fovea.laz.las_columns(points)
        self.assertEqual(len(records), len(points))
        for name in ["red", "green", "blue", "intensity", "classification", "camera", "frame",
                     "range", "interpolated", "views", "spread", "reason"]:
            np.testing.assert_array_equal(columns[name], records[name], name)
        np.testing.assert_array_equal(columns["synthetic"], records["flags"] & 1 != 0)

    def test_wrong_arguments(self):
        points = fovea.Map(sample.map_file()).points()
        for output in ["a.las", "a.copc"]:
            with self.assertRaises(fovea.ConfigError):
                fovea.laz.write(points, sample.folder() / output)
        with self.assertRaises(fovea.ConfigError):
            fovea.laz.write(points, sample.folder() / "a.laz", crs="utm")
        existing = sample.folder() / "existing.laz"
        existing.write_bytes(b"mine")
        with self.assertRaises(fovea.OutputError):
            fovea.laz.write(points, existing)
        with self.assertRaises(fovea.OutputError):
            fovea.laz.write(points, sample.folder() / "nowhere" / "a.laz")


class OctreeTest(unittest.TestCase):
    def test_each_point_is_in_one_node_that_contains_it(self):
        xyz = np.random.default_rng(3).integers(-50_000, 90_000, (200_000, 3))
        xyz[:, 2] //= 10
        low, high = xyz.min(axis=0), xyz.max(axis=0)
        cube = _copc.cube_of(low, high)
        with mock.patch.object(_copc, "_LEAF", 5000):
            nodes = list(_copc.nodes_of(_copc.codes_of(xyz, cube)))
        self.assertGreater(len(nodes), 8)
        np.testing.assert_array_equal(np.sort(np.concatenate([points for _, points in nodes])),
                                      np.arange(len(xyz)))
        for (depth, *cell), points in nodes:
            edge = cube.edge / 2**depth
            corner = cube.low + edge * np.array(cell)
            self.assertTrue((xyz[points] >= corner - 1e-6).all())
            self.assertTrue((xyz[points] <= corner + edge + 1e-6).all())
        self.assertEqual(len({key for key, _ in nodes}), len(nodes))

    def test_one_place(self):
        xyz = np.full((5, 3), 7)
        cube = _copc.cube_of(xyz[0], xyz[0])
        (key, points), = _copc.nodes_of(_copc.codes_of(xyz, cube))
        self.assertEqual(key, (0, 0, 0, 0))
        self.assertEqual(len(points), 5)


class LazTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())

    @needs("laspy", "lazrs")
    def test_a_map_as_laz(self):
        import laspy

        las, laz = sample.folder() / "whole.las", sample.folder() / "whole.laz"
        self.map.export(las, crs="utm", where="range < 15")
        fovea.laz.write(self.map, laz, crs="utm", where="range < 15")
        expected, written = laspy.read(las), laspy.read(laz)
        np.testing.assert_array_equal(written.points.array, expected.points.array)
        crs = [vlr.string for vlr in written.vlrs if vlr.record_id == 2112]
        self.assertIn("UTM zone 32N", crs[0])
        with self.assertRaises(fovea.OutputError):
            fovea.laz.write(self.map, laz)
        fovea.laz.write(sample.map_file(), laz, force=True)
        self.assertEqual(list(sample.folder().glob(".*.laz.*")), [])

    @needs("laspy", "lazrs")
    def test_points_as_laz(self):
        import laspy

        points = self.map.points("views >= 2")
        laz = sample.folder() / "points.laz"
        fovea.laz.write(points, laz)
        written = laspy.read(laz)
        np.testing.assert_allclose(written.xyz, points.xyz, atol=0.00051)
        for name in ["red", "intensity", "camera", "frame", "range", "views"]:
            np.testing.assert_array_equal(written[name], fovea.laz.las_columns(points)[name])

    @needs("laspy", "copclib")
    def test_copc(self):
        import copclib
        import laspy

        las, copc = sample.folder() / "copc.las", sample.folder() / "whole.copc.laz"
        self.map.export(las, crs="utm")
        with mock.patch.object(_copc, "_LEAF", 500):
            fovea.laz.write(self.map, copc, crs="utm")
        reader = copclib.FileReader(str(copc))
        self.assertGreater(len(reader.GetAllNodes()), 8)
        self.assertIn("UTM zone 32N", reader.copc_config.wkt)
        order = ["X", "Y", "Z", "gps_time", "frame", "red", "green", "range", "incidence"][:8]
        expected, written = laspy.read(las).points.array, laspy.read(copc).points.array
        np.testing.assert_array_equal(np.sort(written, order=order), np.sort(expected, order=order))
        first = laspy.read(las)
        x, y, z = first.xyz[0]
        box = copclib.Box(x - 1, y - 1, z - 1, x + 1, y + 1, z + 1)
        inside = (np.abs(first.xyz - first.xyz[0]) <= 1 + 1e-9).all(axis=1).sum()
        self.assertEqual(len(reader.GetPointsWithinBox(box)), inside)


class PlotTest(unittest.TestCase):
    def test_the_picture_has_the_highest_points(self):
        points = fovea.Map(sample.map_file()).points("camera >= 0")
        picture, (left, right, bottom, top) = _plot.top_picture(points, 0.5)
        self.assertEqual(picture.shape, (round((top - bottom) / 0.5), round((right - left) / 0.5), 3))
        highest = points.xyz[:, 2].argmax()
        x, y, _ = points.xyz[highest]
        pixel = picture[int((top - y) / 0.5), int((x - left) / 0.5)]
        np.testing.assert_array_equal(pixel, points.color[highest])
        for pixel in [0, -1, 1e-6, float("nan")]:
            with self.assertRaises(ValueError):
                _plot.top_picture(points, pixel)
        with self.assertRaises(ValueError):
            _plot.top_picture(points[:0], 0.5)

    @needs("matplotlib")
    def test_plot_top(self):
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot

        opened = fovea.Map(sample.map_file())
        axes = opened.plot_top(where="camera >= 0", pixel=0.2)
        self.assertEqual(axes.get_xlabel(), "x (m)")
        figure, mine = pyplot.subplots()
        self.assertIs(opened.plot_top(mine), mine)
        figure.savefig(sample.folder() / "top.png")


if __name__ == "__main__":
    unittest.main()
