"""laspy reads our LAS 1.4 files: points, colors, extra bytes, times and the coordinate system."""
import unittest

import fovea
import laspy
import numpy as np
import pyproj

import sample

EXTRA = {"camera": "i1", "frame": "<i4", "range": "<f4", "interpolated": "u1", "views": "u1", "spread": "u1",
         "reason": "u1"}


def colors(las: laspy.LasData) -> np.ndarray:
    return np.column_stack([las.red, las.green, las.blue])


class LaspyTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())

    def test_points_are_those_of_the_map(self):
        las = laspy.read(sample.export("local.las"))
        points = self.map.points()
        self.assertEqual(str(las.header.version), "1.4")
        self.assertEqual(las.header.point_format.id, 7)
        extra = [np.asarray(las[name]) for name in EXTRA]
        sample.assert_same_points(
            [sample.positions(points), points.color, points.intensity, *(getattr(points, name) for name in EXTRA)],
            [las.xyz, colors(las) / 257, las.intensity / 65535, *extra])
        np.testing.assert_array_equal(las.synthetic, las.interpolated)

    def test_extra_bytes_have_their_types(self):
        las = laspy.read(sample.export("local.las"))
        dimensions = {dimension.name: dimension.dtype for dimension in las.point_format.extra_dimensions}
        self.assertEqual(dimensions, {name: np.dtype(dtype) for name, dtype in EXTRA.items()})

    def test_times_are_those_of_the_frames(self):
        las = laspy.read(sample.export("local.las"))
        self.assertEqual(las.header.global_encoding.gps_time_type, laspy.header.GpsTimeType.STANDARD)
        leap_seconds, gps_epoch = 18, 315964800  # of 2026; Unix time of 6 January 1980
        stamps = np.array([frame.stamp for frame in self.map.frames]) * 1e-9
        expected = stamps[las.frame] - gps_epoch + leap_seconds - 1e9
        np.testing.assert_allclose(las.gps_time, expected, rtol=0, atol=1e-6)

    def test_utm_coordinates_have_their_system(self):
        local, utm = (laspy.read(sample.export(f"{crs}.las", "--crs", crs)) for crs in ("local", "utm"))
        system = utm.header.parse_crs()
        self.assertEqual(system.to_2d().to_epsg(), 32632)
        self.assertEqual([axis.direction for axis in system.axis_info], ["east", "north", "up"])
        # PROJ takes the UTM coordinates to the local ones, by the map's origin.
        latitude, longitude, height = (float(self.map.meta[f"origin.{name}"])
                                       for name in ("latitude_deg", "longitude_deg", "height_m"))
        to_local = pyproj.Transformer.from_pipeline(
            "+proj=pipeline +step +inv +proj=utm +zone=32 +ellps=WGS84 +step +proj=cart +ellps=WGS84 "
            f"+step +proj=topocentric +ellps=WGS84 +lat_0={latitude!r} +lon_0={longitude!r} +h_0={height!r}")
        places = np.column_stack(to_local.transform(utm.x, utm.y, utm.z))
        np.testing.assert_allclose(places, local.xyz, atol=0.003)


if __name__ == "__main__":
    unittest.main()
