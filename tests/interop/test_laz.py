"""laspy reads the LAZ files of fovea.laz, and copclib its COPC files: the points of the LAS export."""
import pathlib
import unittest

import copclib
import fovea
import fovea.laz
import laspy
import numpy as np

import sample

ATTRIBUTES = ("intensity", "red", "green", "blue", "gps_time", "synthetic", "camera", "frame", "range",
              "interpolated", "views", "spread", "reason")


def columns(las: laspy.LasData | laspy.ScaleAwarePointRecord) -> list[np.ndarray]:
    """Positions, then the attributes with 16 bits scaled to 8: positions and attributes count alike."""
    scales = {name: 257 for name in ("intensity", "red", "green", "blue")}
    times = np.asarray(las.gps_time) - np.floor(np.min(las.gps_time))
    return [np.column_stack([las.x, las.y, las.z]),
            *(times if name == "gps_time" else np.asarray(las[name]) / scales.get(name, 1) for name in ATTRIBUTES)]


class LazTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())
        self.las = laspy.read(sample.export("utm.las", "--crs", "utm"))

    def write(self, source: fovea.Map | fovea.Points, name: str, **options: object) -> pathlib.Path:
        path = sample.folder() / name
        fovea.laz.write(source, path, force=True, **options)
        return path

    def test_laz(self):
        laz = laspy.read(self.write(self.map, "utm.laz", crs="utm"))
        self.assertEqual(laz.header.parse_crs(), self.las.header.parse_crs())
        sample.assert_same_points(columns(self.las), columns(laz))

    def test_laz_of_points(self):
        points = self.map.points()
        laz = laspy.read(self.write(points, "points.laz"))
        sample.assert_same_points([sample.positions(points), points.color, points.frame, points.range],
                                  [laz.xyz, np.column_stack([laz.red, laz.green, laz.blue]) / 257, laz["frame"],
                                   laz["range"]])

    def test_copc(self):
        path = self.write(self.map, "utm.copc.laz", crs="utm")
        with laspy.CopcReader.open(path) as reader:
            sample.assert_same_points(columns(self.las), columns(reader.query()))

    def test_the_coordinate_system_of_copc(self):
        path = self.write(self.map, "utm.copc.laz", crs="utm")
        self.assertEqual(laspy.read(path).header.parse_crs(), self.las.header.parse_crs())

    def test_copclib_reads_each_node(self):
        reader = copclib.FileReader(str(self.write(self.map, "utm.copc.laz", crs="utm")))
        nodes = reader.GetAllNodes()
        self.assertEqual(sum(node.point_count for node in nodes), len(self.las))
        places = []
        for node in nodes:
            points = reader.GetPoints(node)
            self.assertTrue(points.Within(copclib.Box(node.key, reader.copc_config.las_header)), node.key)
            places.append(np.column_stack([points.x, points.y, points.z]))
        sample.assert_same_points([np.asarray(self.las.xyz)], [np.concatenate(places)])


if __name__ == "__main__":
    unittest.main()
