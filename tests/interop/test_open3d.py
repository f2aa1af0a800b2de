"""Open3D reads our PLY and PCD files: points, colors and its columns of other types."""
import pathlib
import unittest

import fovea
import numpy as np
import open3d

import sample

COLUMNS = ("frame", "range", "intensity", "views", "spread", "reason", "interpolated")  # the PLY reader leaves out int8


class Open3dTest(unittest.TestCase):
    def setUp(self):
        self.points = fovea.Map(sample.map_file()).points()

    def check(self, path: pathlib.Path) -> open3d.t.geometry.PointCloud:
        """The tensors have the points and columns of the map."""
        tensors = open3d.t.io.read_point_cloud(str(path))
        columns = [tensors.point[column].numpy() for column in ("positions", "colors", *COLUMNS)]
        sample.assert_same_points(
            [sample.positions(self.points), self.points.color, *(getattr(self.points, name) for name in COLUMNS)],
            columns)
        return tensors

    def check_legacy(self, path: pathlib.Path) -> None:
        """The older class has the points and colors of the map."""
        cloud = open3d.io.read_point_cloud(str(path))
        self.assertFalse(cloud.has_normals())
        sample.assert_same_points([sample.positions(self.points), self.points.color],
                                  [np.asarray(cloud.points), np.asarray(cloud.colors) * 255])

    def test_ply(self):
        path = sample.export("cloud.ply")
        self.check(path)
        self.check_legacy(path)

    def test_pcd(self):
        path = sample.export("cloud.pcd")
        self.check_legacy(path)
        self.assertEqual(set(np.unique(self.check(path).point["camera"].numpy())), {0})

    def test_doubles(self):
        # The older class reads the doubles of a PCD file as zeros.
        for name in ("double.ply", "double.pcd"):
            with self.subTest(name):
                tensors = self.check(sample.export(name, "--double"))
                self.assertEqual(tensors.point["positions"].dtype, open3d.core.float64)
        self.check_legacy(sample.export("double.ply", "--double"))


if __name__ == "__main__":
    unittest.main()
