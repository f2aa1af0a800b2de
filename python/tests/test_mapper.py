"""fovea.Drive and fovea.Mapper: frame by frame."""
import unittest
import warnings

import fovea
import numpy as np

import sample


class DriveTest(unittest.TestCase):
    def test_frames_are_arrays(self):
        drive = fovea.Drive(sample.drive(), cameras=[2, 3])
        self.assertEqual(drive.frames, range(sample.FRAMES))
        self.assertEqual([camera.index for camera in drive.cameras], [2, 3])
        self.assertEqual(drive.cameras[0].K.shape, (3, 3))
        self.assertEqual(drive.cameras[0].T_cam_lidar.shape, (4, 4))
        frame = drive.load(1)
        self.assertEqual((frame.points.dtype, frame.points.shape[1]), (np.float32, 3))
        self.assertEqual(frame.intensity.shape, frame.points.shape[:1])
        camera = drive.cameras[1]
        self.assertEqual(frame.images[3].shape, (camera.height, camera.width, 3))
        points, image = frame.points, frame.images[2]
        expected = points.copy(), image.copy()
        del frame, drive
        np.testing.assert_array_equal(points, expected[0])
        np.testing.assert_array_equal(image, expected[1])
        with self.assertRaises(ValueError):
            image[0] = 0

    def test_a_frame_that_cannot_be_used_is_told_of(self):
        drive = fovea.Drive(sample.drive())
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            indices = [frame.index for frame in drive]
        self.assertEqual(indices, sample.USED)
        self.assertEqual(len(caught), 1)
        self.assertIn(f"frame {sample.WITHOUT_SCAN} is skipped", str(caught[0].message))
        with self.assertRaises(fovea.InputError):
            drive.load(sample.WITHOUT_SCAN)
        with self.assertRaises(IndexError):
            drive.load(sample.FRAMES)


class MapperTest(unittest.TestCase):
    def test_has_the_points_of_the_file(self):
        drive = fovea.Drive(sample.drive())
        mapper = fovea.Mapper(drive, settings=sample.SETTINGS)
        kept = None
        for index in sample.USED:
            record = mapper.process(drive.load(index), held_out=index == sample.HELD_OUT)
            self.assertEqual(record.index, index)
            if kept is None:
                kept = {id: (tile.color, tile.color.copy()) for id, tile in mapper.tiles().items()}
        expected = fovea.Map(sample.map_file())
        tiles = mapper.tiles()
        self.assertEqual({id: len(tile) for id, tile in tiles.items()}, expected.tiles())
        self.assertEqual(mapper.size, expected.size)
        for id, tile in expected:
            np.testing.assert_array_equal(tiles[id].position, tile.position)
            np.testing.assert_array_equal(tiles[id].color, tile.color)
        for color, before in kept.values():  # later frames leave earlier arrays alone
            np.testing.assert_array_equal(color, before)

    def test_begins_with_the_motion_of_two_scans_where_navigation_says_nothing(self):
        first = []
        for use_navigation in True, False:
            drive = fovea.Drive(sample.drive(), use_navigation=use_navigation)
            mapper = fovea.Mapper(drive, settings=sample.SETTINGS)
            first.append(mapper.process(drive.load(0)))
        self.assertGreater(first[0].velocity[3], 5)
        np.testing.assert_allclose(first[1].velocity, first[0].velocity, atol=0.3)

    def test_only_the_drives_own_frames_in_order(self):
        drive = fovea.Drive(sample.drive(), frames=(0, 2))
        mapper = fovea.Mapper(drive, settings=sample.SETTINGS)
        with self.assertRaises(ValueError):
            mapper.process(fovea.Drive(sample.drive()).load(0))
        mapper.process(drive.load(1))
        with self.assertRaises(ValueError):
            mapper.process(drive.load(0))


if __name__ == "__main__":
    unittest.main()
