"""pycolmap reads our models. Points land on the pixels where the drive's own calibration projects them."""
import json
import pathlib
import unittest

import fovea
import numpy as np
import PIL.Image
import pycolmap

import sample

CENTER = 0.5  # of the first pixel, for COLMAP and NeRF; 0 for Fovea
CAMERA_AXES = np.diag([1.0, -1.0, -1.0])  # OpenGL's to Fovea's


def projected(K: np.ndarray, points_cam: np.ndarray) -> np.ndarray:
    return (points_cam @ K.T)[:, :2] / points_cam[:, 2:]


class ColmapTest(unittest.TestCase):
    def setUp(self):
        self.frames = {frame.index: frame for frame in fovea.Map(sample.map_file()).frames}
        (self.camera,) = fovea.Drive(sample.drive(), cameras=[0]).cameras
        positions = sample.positions(fovea.Map(sample.map_file()).points())
        self.points = positions[:: max(1, len(positions) // 5000)]

    def expected(self, frame: int) -> tuple[np.ndarray, np.ndarray]:
        """The points in front of the camera, and their pixels by the calibration of the drive."""
        T_local_lidar = self.frames[frame].T_local_lidar
        T_cam_local = self.camera.T_cam_lidar @ np.linalg.inv(T_local_lidar)
        points_cam = self.points @ T_cam_local[:3, :3].T + T_cam_local[:3, 3]
        is_ahead = points_cam[:, 2] > 1
        return self.points[is_ahead], projected(self.camera.K, points_cam[is_ahead]) + CENTER

    def frame_of(self, name: str) -> int:
        return int(pathlib.PurePath(name).stem.split("_")[-1])

    def test_colmap(self):
        folder = sample.export("model", "--format", "colmap", "--drive", str(sample.drive()))
        model = pycolmap.Reconstruction(folder / "sparse" / "0")
        self.assertEqual(model.num_images(), len(self.frames))
        self.assertGreater(model.num_points3D(), 1000)
        for image in model.images.values():
            self.assertTrue((folder / "images" / image.name).is_file(), image.name)
            points, pixels = self.expected(self.frame_of(image.name))
            camera = model.cameras[image.camera_id]
            self.assertEqual(camera.model_name, "PINHOLE")
            found = camera.img_from_cam(image.cam_from_world() * points)
            np.testing.assert_allclose(found, pixels, atol=1e-3)

    def test_images_have_the_colors_of_their_points(self):
        folder = sample.export("model", "--format", "colmap", "--drive", str(sample.drive()))
        model = pycolmap.Reconstruction(folder / "sparse" / "0")
        for image in model.images.values():
            pixels = np.asarray(PIL.Image.open(folder / "images" / image.name).convert("RGB")).astype(float)
            camera = model.cameras[image.camera_id]
            self.assertEqual(pixels.shape, (camera.height, camera.width, 3))
            seen = fovea.Map(sample.map_file()).points(where=f"frame == {self.frame_of(image.name)}")
            found = camera.img_from_cam(image.cam_from_world() * sample.positions(seen))
            columns, rows = np.floor(found).astype(int).T  # pixel 0 is from 0 to 1
            is_inside = (columns >= 0) & (columns < camera.width) & (rows >= 0) & (rows < camera.height)
            self.assertGreater(is_inside.sum(), 500)
            greens = pixels[rows[is_inside], columns[is_inside], 1], seen.color[is_inside, 1]
            self.assertGreater(np.corrcoef(*greens)[0, 1], 0.85)  # one pixel off: 0.8 in the median

    def test_points_are_those_of_the_map(self):
        folder = sample.export("model", "--format", "colmap")
        model = pycolmap.Reconstruction(folder / "sparse" / "0")
        places = np.array([point.xyz for point in model.points3D.values()])
        colors = np.array([point.color for point in model.points3D.values()])
        points = fovea.Map(sample.map_file()).points()
        sample.assert_contained([places, colors], [sample.positions(points), points.color])

    def test_nerf(self):
        folder = sample.export("nerf", "--format", "nerf", "--drive", str(sample.drive()))
        transforms = json.loads((folder / "transforms.json").read_text())
        self.assertEqual(len(transforms["frames"]), len(self.frames))
        for frame in transforms["frames"]:
            self.assertTrue((folder / frame["file_path"]).is_file(), frame["file_path"])
            intrinsics = {key: frame.get(key, transforms.get(key)) for key in ("fl_x", "fl_y", "cx", "cy")}
            K = np.array([[intrinsics["fl_x"], 0, intrinsics["cx"]], [0, intrinsics["fl_y"], intrinsics["cy"]],
                          [0, 0, 1]])
            points, pixels = self.expected(self.frame_of(frame["file_path"]))
            T_local_gl = np.array(frame["transform_matrix"])
            points_cam = (points - T_local_gl[:3, 3]) @ T_local_gl[:3, :3] @ CAMERA_AXES
            np.testing.assert_allclose(projected(K, points_cam), pixels, atol=1e-3)


if __name__ == "__main__":
    unittest.main()
