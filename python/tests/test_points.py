"""fovea.Points: choices of points, and tables of them."""
import gc
import unittest

import fovea
import numpy as np

import sample


class PointsTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())
        self.points = self.map.points()

    def expect_rows(self, chosen, rows):
        """Whether all columns of chosen points are those of `rows`."""
        self.assertIsInstance(chosen, fovea.Points)
        table = self.points.to_structured()[rows]
        self.assertEqual(len(chosen), len(table))
        sample.expect_same_points(chosen, table)
        np.testing.assert_array_equal(chosen.xyz, self.points.xyz[rows])

    def test_slices_share_the_memory(self):
        n = len(self.points)
        for rows in [slice(10, 20), slice(None, None, 2), slice(n, 0, -3), slice(None, None, -1),
                     slice(-5, None), slice(7, 7), slice(n, None), slice(3, 10 * n)]:
            chosen = self.points[rows]
            self.expect_rows(chosen, rows)
            if len(chosen) > 0:
                self.assertTrue(np.shares_memory(chosen.position, self.points.position), rows)

    def test_a_slice_of_a_slice(self):
        self.expect_rows(self.points[100:10:-2][3:20:4], np.arange(100, 10, -2)[3:20:4])
        self.expect_rows(self.points[10:50][[0, -1]], [10, 49])

    def test_masks_and_indices(self):
        for rows in [self.points.range < 10, np.zeros(len(self.points), bool),
                     np.array([5, 2, 2, -1]), np.array([7], np.uint8), [3, 1], []]:
            self.expect_rows(self.points[rows], np.asarray(rows, None if len(rows) else int))

    def test_one_point_is_a_row(self):
        row = self.points[-1]
        self.assertIsInstance(row, np.void)
        self.assertEqual(row["frame"], self.points.frame[-1])
        np.testing.assert_array_equal(row["position"], self.points.position[-1])
        self.assertEqual(self.points[np.int64(3)], self.points[3])

    def test_wrong_choices_are_pythons_errors(self):
        n = len(self.points)
        for key in [n, -n - 1, 10**30, [0, n], np.zeros(n - 1, bool)]:
            with self.assertRaises(IndexError):
                self.points[key]
        for key in ["frame", 1.5, None, (0, 1), True, np.zeros((n, 2), bool), np.array([1.5])]:
            with self.assertRaises(TypeError, msg=repr(key)):
                self.points[key]
        with self.assertRaises(ValueError):
            self.points[::0]

    def test_tables_have_the_columns(self):
        table = np.asarray(self.points)
        self.assertEqual(table.shape, (len(self.points),))
        self.assertEqual(table.dtype.names, (
            "position", "color", "camera", "frame", "range", "incidence", "interpolated", "views",
            "spread", "weight", "reason", "intensity"))
        for name in table.dtype.names:
            column = getattr(self.points, name)
            np.testing.assert_array_equal(table[name], column)
            self.assertEqual(table[name].dtype, column.dtype)
        table["range"] = 0  # a copy
        self.assertGreater(self.points.range.max(), 0)
        with self.assertRaises(ValueError):
            self.points.__array__(copy=False)

    def test_positions_with_their_origin(self):
        _, tile = next(iter(self.map))
        self.assertGreater(np.abs(tile.origin).max(), 0)
        self.assertEqual(tile.xyz.dtype, np.float64)
        np.testing.assert_array_equal(tile.xyz, tile.origin + tile.position)
        np.testing.assert_array_equal(tile[1:].origin, tile.origin)
        tile.xyz[0] = 0  # it can be written

    def test_views_outlive_the_points(self):
        column = self.points[5:].range
        expected = column.copy()
        del self.points
        gc.collect()
        self.setUp()
        np.testing.assert_array_equal(column, expected)
        with self.assertRaises(ValueError):
            column[0] = 0

    def test_length_and_text(self):
        self.assertEqual(len(self.points[:12]), 12)
        self.assertEqual(repr(self.points[:12]), "<fovea.Points: 12 points>")


if __name__ == "__main__":
    unittest.main()
