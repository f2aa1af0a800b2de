"""fovea.Map: closing, boxes and what it states about itself."""
import shutil
import unittest

import fovea
import numpy as np

import sample


class ClosingTest(unittest.TestCase):
    def test_with_closes_the_map(self):
        with fovea.Map(sample.map_file()) as opened:
            self.assertFalse(opened.closed)
            points = opened.points()
        self.assertTrue(opened.closed)
        self.assertGreater(len(points.position), 0)  # what was read stays
        self.assertEqual(repr(opened), f"<fovea.Map '{sample.map_file()}': closed>")
        self.assertEqual(opened.path, sample.map_file())
        opened.close()  # as of files, no error

    def test_a_closed_map_is_a_value_error(self):
        opened = fovea.Map(sample.map_file())
        tiles = iter(opened)
        next(tiles)
        opened.close()
        for use in [len, iter, lambda m: m.points(), lambda m: m.meta, lambda m: m.frames,
                    lambda m: m.submaps, lambda m: m.tiles(), lambda m: m.digest(),
                    lambda m: m.tile((0, 0, 0, 0)), lambda m: m.size, lambda m: m.__enter__(),
                    lambda m: m.export(sample.folder() / "closed.ply"), lambda m: m.render(),
                    lambda m: next(tiles)]:
            with self.assertRaisesRegex(ValueError, "the map is closed"):
                use(opened)

    def test_the_file_is_closed(self):
        copy = sample.folder() / "closing.fovea"
        shutil.copy(sample.map_file(), copy)
        opened = fovea.Map(copy)
        self.assertIn(str(copy), sample.open_files())
        opened.close()
        self.assertNotIn(str(copy), sample.open_files())


class ReadingTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())

    def test_length_and_text(self):
        self.assertEqual(len(self.map), self.map.size)
        self.assertEqual(repr(self.map), f"<fovea.Map '{sample.map_file()}': {self.map.size} "
                         f"points, {sample.FRAMES} frames>")

    def test_points_of_a_box(self):
        points = self.map.points()
        low, high = np.percentile(points.position, [30, 60], axis=0)
        inside = ((points.position >= low) & (points.position <= high)).all(axis=1)
        self.assertGreater(inside.sum(), 0)
        found = self.map.points(box=(low, high))
        sample.expect_same_points(found, points[inside].to_structured())
        both = self.map.points("range < 10", box=(low, high))
        expected = points[inside & (points.range < 10)]
        sample.expect_same_points(both, expected.to_structured())
        self.assertEqual(len(self.map.points(box=[[1e6, 0, 0], [1e6 + 1, 1, 1]])), 0)

    def test_a_box_is_two_corners(self):
        for box in [(0, 0, 0), ((0, 0), (1, 1)), np.zeros((3, 2)), 5]:
            with self.assertRaisesRegex(ValueError, "two corners"):
                self.map.points(box=box)
        for box in [((0, 0, 0), (0, 1, 1)), ((1, 1, 1), (0, 0, 0)), np.full((2, 3), np.nan)]:
            with self.assertRaises(fovea.ConfigError):
                self.map.points(box=box)

    def test_meta_has_types(self):
        meta = self.map.meta
        self.assertIsInstance(meta, dict)
        self.assertEqual(meta["frames.end"], str(sample.FRAMES))
        self.assertEqual(meta.frames, range(sample.FRAMES))
        self.assertEqual(meta.cameras, (2,))
        self.assertEqual(meta.hold_out, sample.HOLD_OUT)
        self.assertEqual(meta.fovea_version, fovea.__version__)
        self.assertEqual(meta.format_version, int(meta["format_version"]))
        self.assertEqual(meta.drive_kind, "kitti-raw")
        self.assertTrue(meta.complete)
        self.assertEqual(meta.poses, "refine")
        self.assertEqual(meta.tile_size, 4)
        self.assertTrue(meta.georeferenced)
        self.assertAlmostEqual(meta.origin.latitude, float(meta["origin.latitude_deg"]))
        self.assertEqual(len(meta.origin), 3)
        self.assertIsNone(meta.crop)
        self.assertEqual(meta.settings["surface.spacing_m"], sample.SETTINGS["surface.spacing_m"])

    def test_settings_of_a_map_make_another_one(self):
        settings = {key: value for key, value in self.map.meta.settings.items() if "." in key}
        output = sample.folder() / "again.fovea"
        fovea.map_drive(sample.drive(), output, settings=settings, hold_out=self.map.meta.hold_out)
        self.assertEqual(fovea.Map(output).digest(), self.map.digest())

    def test_meta_of_a_map_that_lost_keys(self):
        empty = fovea.Meta()
        self.assertEqual(empty.frames, range(0))
        self.assertEqual(empty.cameras, ())
        self.assertEqual(empty.settings, {})
        self.assertEqual(empty.notes, ())
        self.assertFalse(empty.complete)
        self.assertIsNone(empty.origin)


if __name__ == "__main__":
    unittest.main()
