"""The stages as functions over arrays: known answers, and wrong arguments."""
import threading
import time
import unittest

import fovea
import numpy as np

import sample

CAMERA = fovea.Camera(100, 80, [[50, 0, 50], [0, 50, 40], [0, 0, 1]])


def grid(xs, ys):
    return np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)


def wall(depth, step=0.2):
    """Points of a plane that faces the camera."""
    steps = round(1 / step)
    xy = grid(np.arange(-steps, steps + 1), np.arange(-steps, steps + 1)) * step
    return np.column_stack([xy, np.full(len(xy), float(depth))])


class Deskew(unittest.TestCase):
    def test_moves_points_by_their_times(self):
        motion = fovea.SweepMotion([0, 0, 0, 10, 0, 0])
        points = np.array([[5, 1, 0], [5, 2, 0], [5, 3, 0]], np.float32)
        moved = fovea.compensate_sweep(points, motion, times=[-0.05, 0, 0.02])
        np.testing.assert_allclose(moved, points + [[-0.5, 0, 0], [0, 0, 0], [0.2, 0, 0]],
                                   atol=1e-5)
        moved[0] = 0  # the result is the caller's
        np.testing.assert_array_equal(points[0], [5, 1, 0])

    def test_finds_times_by_the_azimuth(self):
        sweep = fovea.SweepTiming(period=0.2, direction="counterclockwise", start_azimuth=0,
                                  stamp_phase=0)
        motion = fovea.SweepMotion([0, 0, 0, 0, 0, 1])
        moved = fovea.compensate_sweep([[0, 4, 0], [0, -4, 0]], motion, sweep=sweep)
        np.testing.assert_allclose(moved[:, 2], [0.05, 0.15], atol=1e-4)


class Ground(unittest.TestCase):
    def test_is_below_a_height_or_on_a_plane(self):
        road = np.column_stack([grid(np.arange(2, 20, 0.5), np.arange(-8, 8, 0.5)),
                                np.zeros(36 * 32)])
        road[:, 2] = -1.5 + 0.05 * road[:, 0]
        above = road[::7] + [0, 0, 1]
        points = np.vstack([road, above])
        is_ground = fovea.segment_ground(points, method="ransac", sensor_height=1.5)
        self.assertEqual(is_ground.dtype, bool)
        np.testing.assert_array_equal(is_ground, np.arange(len(points)) < len(road))
        flat = fovea.segment_ground(points, sensor_height=1.5, tolerance=0.26)
        np.testing.assert_array_equal(flat, points[:, 2] < -1.24)

    def test_height_of_the_sensor(self):
        points = fovea.Drive(sample.drive(), use_images=False)[0].points
        self.assertAlmostEqual(fovea.sensor_height(points), 1.73, delta=0.1)
        self.assertIsNone(fovea.sensor_height(np.zeros((0, 3))))


class Upsampling(unittest.TestCase):
    def test_adds_the_centroid_of_a_short_triangle(self):
        corners = np.array([[0, 0, 2], [0.2, 0, 2], [0, 0.2, 2]], np.float32)
        dense = fovea.upsample(corners, CAMERA, rate=1, max_edge=0.3)
        np.testing.assert_array_equal(dense.position[:3], corners)
        np.testing.assert_allclose(dense.position[3:], [corners.mean(axis=0)], atol=1e-6)
        np.testing.assert_array_equal(dense.interpolated, [False] * 3 + [True])
        np.testing.assert_allclose(dense.normal[3], [0, 0, -1], atol=1e-6)
        self.assertEqual(len(fovea.upsample(corners, CAMERA, max_edge=0.1).position), 3)

    def test_leaves_the_ground_as_it_is(self):
        corners = np.array([[0, 0, 2], [0.2, 0, 2], [0, 0.2, 2]], np.float32)
        for is_ground, count in [(False, 4), (True, 3)]:
            dense = fovea.upsample_non_ground(corners, [is_ground] * 3, [CAMERA], rate=1)
            self.assertEqual(len(dense), count)


class Registration(unittest.TestCase):
    def test_finds_the_motion_between_two_scans(self):
        drive = fovea.Drive(sample.drive(), frames=(0, 2), use_images=False)
        scans = [fovea.compensate_sweep(frame.points, frame.motion, sweep=drive.sweep)
                 for frame in drive]
        expected = np.linalg.inv(drive[0].T_local_lidar) @ drive[1].T_local_lidar
        result = fovea.register_scans(*scans)
        self.assertTrue(result.converged)
        self.assertTrue(fovea.scan_fit(*scans, result.T_target_source).shows_one_place)
        turned = np.diag([-1.0, -1, 1, 1])
        self.assertFalse(fovea.scan_fit(*scans, turned).shows_one_place)
        np.testing.assert_allclose(result.T_target_source, expected, atol=0.05)
        self.assertGreater(result.pairs, 1000)
        self.assertTrue((np.linalg.eigvalsh(result.information) > 0).all())
        near = fovea.register_scans(*scans, expected, max_points=20000, robust_width=0.1,
                                    prior=expected, prior_sigma=[0.01] * 3 + [0.1] * 3)
        np.testing.assert_allclose(near.T_target_source, expected, atol=0.05)

    def test_too_few_points_keep_the_guess(self):
        guess = np.eye(4)
        guess[0, 3] = 0.5
        result = fovea.register_scans(np.full((9, 3), np.nan), np.zeros((0, 3)), guess)
        self.assertFalse(result.converged)
        np.testing.assert_array_equal(result.T_target_source, guess)


class View(unittest.TestCase):
    def test_the_region_has_zones_and_slices(self):
        points = np.array([[0, 0, 2], [0, 0, 5], [2, 0, 5], [0, 0, 30], [0, 0, -5]], np.float32)
        region = fovea.FovealRegion(CAMERA, near_range=3, far_range=18)
        inside = region.contains(points)
        np.testing.assert_array_equal(inside, [False, True, True, False, False])
        np.testing.assert_array_equal(fovea.foveal_points(points, region), points[inside])
        narrow = fovea.FovealRegion(CAMERA, slices=[(-0.1, 0.1, -0.2, 0.2)])
        np.testing.assert_array_equal(narrow.contains(points), [0, 1, 0, 0, 0])

    def test_the_ray_filter_separates_what_is_hidden(self):
        points = np.vstack([wall(5), [[0, 0, 2.5], [0, 0, -3], [50, 0, 5]]])
        verdicts = fovea.ray_filter(points, CAMERA, window=9)
        behind = np.flatnonzero((points == [0, 0, 5]).all(axis=1))
        self.assertEqual(verdicts[behind], fovea.RayVerdict.SHARED)
        np.testing.assert_array_equal(verdicts[-2:], [fovea.RayVerdict.OUTSIDE] * 2)
        self.assertEqual(verdicts[0], fovea.RayVerdict.VISIBLE)
        hiding = fovea.ray_filter(wall(5), CAMERA, map_points_cam=wall(5) * 2)
        np.testing.assert_array_equal(hiding, [fovea.RayVerdict.OCCLUDING] * len(hiding))

    def test_samples_of_a_wall_are_on_it(self):
        samples = fovea.sample_surfaces(wall(5), CAMERA, spacing=0.05, max_per_pixel=0)
        np.testing.assert_allclose(samples.position[:, 2], 5, atol=1e-4)
        self.assertAlmostEqual(len(samples.position), (2 / 0.05) ** 2, delta=100)
        self.assertEqual(set(samples.level), {0})
        np.testing.assert_allclose(samples.normal[-1], [0, 0, -1], atol=1e-5)

    def test_colors_come_from_the_image(self):
        image = np.zeros((80, 100, 3), np.uint8)
        image[..., 0] = np.arange(100)
        image[..., 1] = np.arange(80)[:, None]
        points = np.array([[0, 0, 5], [0.25, 0.5, 5], [0, 0, -5], [50, 0, 5]])
        color, is_seen = fovea.color_points(points, image, CAMERA)
        np.testing.assert_array_equal(is_seen, [True, True, False, False])
        np.testing.assert_array_equal(color[:2], [[50, 40, 0], [53, 45, 0]])
        shown = np.ones((80, 100), bool)
        shown[40, 50] = False
        for mask in shown, shown * np.uint8(255):
            seen = fovea.color_points(points, image, CAMERA, mask=mask).is_seen
            np.testing.assert_array_equal(seen, [False, True, False, False])
        gray = fovea.color_points(points, image[..., 0], CAMERA, sampling="nearest").color
        np.testing.assert_array_equal(gray[0], [50] * 3)


class WrongArguments(unittest.TestCase):
    def expect(self, function, *arguments, **keywords):
        with self.assertRaises(ValueError, msg=(function, arguments, keywords)):
            function(*arguments, **keywords)

    def test_points(self):
        region, image = fovea.FovealRegion(CAMERA), np.zeros((80, 100, 3), np.uint8)
        motion = fovea.SweepMotion(np.zeros(6))
        for points in np.zeros(3), np.zeros((4, 2)), [[0, 0, np.nan]], [[0, 0, np.inf]], [[1e9] * 3]:
            self.expect(fovea.compensate_sweep, points, motion)
            self.expect(fovea.segment_ground, points)
            self.expect(fovea.sensor_height, points)
            self.expect(fovea.upsample, points, CAMERA)
            self.expect(fovea.upsample_non_ground, points, [False], [CAMERA])
            self.expect(fovea.foveal_points, points, region)
            self.expect(region.contains, points)
            self.expect(fovea.ray_filter, points, CAMERA)
            self.expect(fovea.sample_surfaces, points, CAMERA)
            self.expect(fovea.color_points, points, image, CAMERA)
            self.expect(CAMERA.project, points)
        self.expect(fovea.register_scans, np.zeros((4, 2)), np.zeros((4, 3)))
        for function in fovea.upsample, fovea.sample_surfaces:
            self.expect(function, [[0, 0, -1]], CAMERA)

    def test_numbers(self):
        points = wall(5)
        for keywords in {"rate": 6}, {"rate": -1}, {"max_edge": np.nan}:
            self.expect(fovea.upsample, points, CAMERA, **keywords)
        for keywords in ({"neighbors": 0}, {"max_distance": 0}, {"voxel": -1}, {"method": "magic"},
                         {"guess": np.ones((4, 4))}, {"prior": np.eye(4)},
                         {"prior": np.eye(4), "prior_sigma": np.zeros(6)}):
            self.expect(fovea.register_scans, points, points, **keywords)
        for keywords in {"window": 4}, {"window": 0}, {"outlier_rate": -1}:
            self.expect(fovea.ray_filter, points, CAMERA, **keywords)
        for keywords in {"spacing": 0}, {"max_per_pixel": -1}, {"full_density_range": np.nan}:
            self.expect(fovea.sample_surfaces, points, CAMERA, **keywords)
        for keywords in {"slices": [(0, 2, 0, 1)]}, {"far_range": -1}, {"lidar_origins": []}:
            self.expect(fovea.FovealRegion, CAMERA, **keywords)
        self.expect(fovea.segment_ground, points, method="magic")
        self.expect(fovea.SweepTiming, period=0)
        self.expect(fovea.SweepMotion, np.full(6, np.nan))

    def test_columns_and_images(self):
        points, image = wall(5), np.zeros((80, 100, 3), np.uint8)
        motion = fovea.SweepMotion(np.zeros(6))
        self.expect(fovea.compensate_sweep, points, motion, times=[0])
        self.expect(fovea.compensate_sweep, points, motion, times=np.full(len(points), np.nan))
        self.expect(fovea.upsample_non_ground, points, [True], [CAMERA])
        self.expect(fovea.color_points, points, image[1:], CAMERA)
        self.expect(fovea.color_points, points, image.astype(float), CAMERA)
        self.expect(fovea.color_points, points, image, CAMERA, mask=np.ones((8, 8), bool))
        self.expect(fovea.color_points, points, image, CAMERA, sampling="cubic")


class Threads(unittest.TestCase):
    def test_others_run_while_a_stage_works(self):
        points = fovea.Drive(sample.drive(), use_images=False)[0].points
        ended = threading.Event()

        def register():
            fovea.register_scans(points, points, np.eye(4), voxel=0)
            ended.set()

        thread = threading.Thread(target=register)
        thread.start()
        turns = 0
        while not ended.is_set():
            time.sleep(0.001)
            turns += 1
        thread.join()
        self.assertGreater(turns, 20)  # one or two if the stage kept the lock


if __name__ == "__main__":
    unittest.main()
