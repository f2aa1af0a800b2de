"""fovea.Map: what a file holds, as arrays."""
import concurrent.futures
import gc
import pathlib
import resource
import unittest

import fovea
import numpy as np

import sample


def read_ply(path):
    """The vertices of a binary PLY file as a structured array."""
    types = {"float": "<f4", "double": "<f8", "uchar": "u1", "char": "i1", "int": "<i4",
             "ushort": "<u2"}
    with open(path, "rb") as file:
        fields = []
        while (line := file.readline().split()) != [b"end_header"]:
            if line[0] == b"property":
                fields.append((line[2].decode(), types[line[1].decode()]))
        return np.frombuffer(file.read(), dtype=fields)


class MapTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())

    def test_says_what_it_is(self):
        self.assertEqual(self.map.meta["hold_out"], sample.HOLD_OUT)
        self.assertEqual(self.map.path, sample.map_file())
        self.assertEqual(self.map.submaps.shape[1:], (4, 4))
        self.assertEqual(sum(self.map.tiles().values()), self.map.size)
        self.assertEqual(self.map.digest(),
                         sample.run("info", "--digest", sample.map_file()).strip())

    def test_frames_have_poses_and_figures(self):
        frames = self.map.frames
        self.assertEqual([frame.index for frame in frames], list(range(sample.FRAMES)))
        self.assertEqual([frame.status for frame in frames],
                         ["mapped", "mapped", "held-out", "mapped", "skipped", "mapped"])
        first = frames[0]
        self.assertEqual(first.T_local_lidar.shape, (4, 4))
        np.testing.assert_allclose(first.T_local_lidar[:3, :3] @ first.T_local_lidar[:3, :3].T,
                                   np.eye(3), atol=1e-9)
        self.assertEqual(first.velocity.shape, (6,))
        self.assertEqual(first.acceleration.shape, (6,))
        self.assertGreater(first.figures["points_scan"], 0)
        self.assertLess(first.stamp, frames[1].stamp)
        self.assertIn("scan", frames[sample.WITHOUT_SCAN].note)
        (view,) = first.views
        self.assertEqual(str(view.camera), self.map.meta["cameras"])
        self.assertEqual(view.stamp, first.stamp)
        np.testing.assert_allclose(view.log2_gain, np.zeros(3))  # the map's exposure
        self.assertEqual(frames[sample.WITHOUT_SCAN].views, [])

    def test_columns_have_their_types(self):
        count = 0
        for _, tile in self.map:
            n = len(tile)
            count += n
            for name, shape, dtype in [
                    ("position", (n, 3), np.float32), ("color", (n, 3), np.uint8),
                    ("camera", (n,), np.int8), ("frame", (n,), np.int32),
                    ("range", (n,), np.float32), ("incidence", (n,), np.float32),
                    ("interpolated", (n,), np.uint8), ("views", (n,), np.uint8),
                    ("spread", (n,), np.uint8), ("weight", (n,), np.uint16),
                    ("reason", (n,), np.uint8), ("intensity", (n,), np.float32)]:
                column = getattr(tile, name)
                self.assertEqual(column.shape, shape, name)
                self.assertEqual(column.dtype, dtype, name)
            self.assertEqual(tile.origin.shape, (3,))
        self.assertEqual(count, self.map.size)

    def test_points_are_those_that_the_program_exports(self):
        ply = sample.folder() / "exported.ply"
        sample.run("export", sample.map_file(), ply, "--force", "--where", "range < 12")
        exported = read_ply(ply)
        points = self.map.points(where="range < 12 and camera >= 0")
        self.assertEqual(len(points), len(exported))
        self.assertLess(0, len(points))
        self.assertLess(len(points), self.map.size)
        for axis, name in enumerate("xyz"):
            np.testing.assert_allclose(points.position[:, axis], exported[name], atol=1e-4)
        for channel, name in enumerate(["red", "green", "blue"]):
            np.testing.assert_array_equal(points.color[:, channel], exported[name])
        np.testing.assert_array_equal(points.frame, exported["frame"])

    def test_tiles_lie_in_their_submaps(self):
        T_local_submap = self.map.submaps
        positions = []
        for (submap, *key), tile in self.map:
            p_submap = tile.origin + tile.position
            self.assertTrue(np.all(np.abs(p_submap - 4 * (np.array(key) + 0.5)) < 2.001))
            T = T_local_submap[submap]
            positions.append(p_submap @ T[:3, :3].T + T[:3, 3])
        points = self.map.points()
        np.testing.assert_allclose(np.concatenate(positions), points.position, atol=1e-4)
        np.testing.assert_array_equal(points.origin, np.zeros(3))

    def test_arrays_outlive_the_map(self):
        tile_id, tile = next(iter(self.map))
        view = tile.position[1:]
        expected = tile.position[1:].copy()
        del tile, self.map
        gc.collect()
        self.setUp()
        self.map.points()  # takes the memory, were it free
        np.testing.assert_array_equal(view, expected)
        np.testing.assert_array_equal(self.map.tile(tile_id).position[1:], expected)

    def test_arrays_share_their_memory_and_cannot_be_written(self):
        _, tile = next(iter(self.map))
        self.assertTrue(np.shares_memory(tile.position, tile.position))
        with self.assertRaises(ValueError):
            tile.color[0] = 0
        with self.assertRaises(ValueError):
            tile.position[0] = 0

    def test_reading_tiles_again_and_again_keeps_memory(self):
        tile_id = max(self.map.tiles().items(), key=lambda tile: tile[1])[0]
        size = self.map.tile(tile_id).position.nbytes

        def read(times):
            """Bytes that the process has in memory after so many readings."""
            for _ in range(times):
                self.map.tile(tile_id).position.sum()
            pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
            return pages * resource.getpagesize()

        before = read(20)
        times = 200 + 2**26 // size  # what 64 MB of them would be, were they kept
        self.assertLess(read(times) - before, 2**25)

    def test_threads_take_turns(self):
        expected = {id: tile.position.sum() for id, tile in self.map}
        ids = 4 * list(expected)
        with concurrent.futures.ThreadPoolExecutor(4) as threads:
            sums = threads.map(lambda id: self.map.tile(id).position.sum(), ids)
            self.assertEqual(list(sums), [expected[id] for id in ids])

    def test_errors_say_what_where_and_what_to_do(self):
        with self.assertRaises(fovea.InputError) as caught:
            fovea.Map(sample.folder() / "none.fovea")
        self.assertEqual(caught.exception.problem, "the map does not exist")
        self.assertEqual(caught.exception.where, str(sample.folder() / "none.fovea"))
        self.assertEqual(caught.exception.remedy, "check the name")
        self.assertEqual(str(caught.exception), ", ".join(
            [caught.exception.problem, caught.exception.where, caught.exception.remedy]))
        self.assertIsInstance(caught.exception, fovea.Error)
        with self.assertRaises(fovea.ConfigError):
            self.map.points(where="colour is nice")
        with self.assertRaises(fovea.InputError):
            self.map.tile((0, 1000, 0, 0))

    def test_a_damaged_file_is_an_error(self):
        content = bytearray(sample.map_file().read_bytes())
        for place in range(len(content) // 2, len(content), 4096):
            content[place] ^= 0x55
        damaged = sample.folder() / "damaged.fovea"
        damaged.write_bytes(content)
        with self.assertRaises(fovea.InputError):
            fovea.Map(damaged).points()


if __name__ == "__main__":
    unittest.main()
