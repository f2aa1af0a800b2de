"""What is made of a map: exports, pictures, merged maps."""
import unittest

import fovea
import numpy as np

import sample


def program_export(name, *options):
    output = sample.folder() / name
    sample.run("export", sample.map_file(), output, "--force", "--quiet", *options)
    return output.read_bytes()


class ExportTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())

    def test_exports_are_those_of_the_program(self):
        for name, options, words in [
                ("a.ply", {"where": "range < 12"}, ["--where", "range < 12"]),
                ("b.ply", {"double": True, "uncolored": True}, ["--double", "--uncolored"]),
                ("c.las", {"crs": "utm", "color_depth": 16}, ["--crs", "utm", "--color-depth", 16]),
                ("d.pcd", {"exposure": "map"}, ["--exposure", "map"]),
                ("e.txt", {"format": "kitti-poses"}, ["--format", "kitti-poses"])]:
            output = sample.folder() / f"python_{name}"
            self.map.export(output, **options)
            self.assertEqual(output.read_bytes(), program_export(name, *words), name)

    def test_says_how_much_it_wrote(self):
        exported = self.map.export(sample.folder() / "counted.ply", where="views >= 2")
        colored = self.map.points("camera >= 0 and views >= 2")
        self.assertEqual(exported.points, len(colored))
        self.assertGreater(exported.filtered_out, 0)

    def test_errors(self):
        with self.assertRaisesRegex(fovea.ConfigError, "there is no export format 'xyz'"):
            self.map.export(sample.folder() / "a.xyz")
        with self.assertRaises(fovea.ConfigError):
            self.map.export(sample.folder() / "f.ply", where="colour is nice")
        output = sample.folder() / "twice.ply"
        self.map.export(output)
        with self.assertRaises(fovea.OutputError):
            self.map.export(output)
        self.map.export(output, force=True)

    def test_never_replaces_files_of_another_kind(self):
        other = sample.folder() / "other"
        other.write_text("mine")
        for format in ["ply", "las", "glb", "tum"]:
            with self.assertRaises(fovea.OutputError, msg=format):
                self.map.export(other, format, force=True)
        self.assertEqual(other.read_text(), "mine")

    def test_never_replaces_the_map(self):
        before = sample.map_file().read_bytes()
        for format in ["ply", "orthophoto", "3dtiles"]:
            with self.assertRaises(fovea.OutputError, msg=format):
                self.map.export(sample.map_file(), format, force=True)
        with self.assertRaises(fovea.OutputError):
            self.map.render(sample.map_file(), force=True)
        with self.assertRaises(fovea.OutputError):
            fovea.merge(self.map, self.map, sample.map_file(), force=True)
        self.assertEqual(sample.map_file().read_bytes(), before)


class RenderTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())

    def test_a_view_is_the_programs_picture(self):
        mine, theirs = sample.folder() / "mine.png", sample.folder() / "theirs.png"
        image = self.map.render(mine, view="driver", frame=3, width=320, height=200)
        sample.run("render", sample.map_file(), "-o", theirs, "--view", "driver", "--frame", 3,
                   "--width", 320, "--height", 200)
        self.assertEqual(image.shape, (200, 320, 3))
        self.assertEqual(image.dtype, np.uint8)
        self.assertGreater(image.std(), 1)
        self.assertEqual(mine.read_bytes(), theirs.read_bytes())

    def test_a_free_camera(self):
        down = self.map.render(eye=(0, 0, 30), target=(0, 0, 0), width=64, height=64)
        np.testing.assert_array_equal(
            down, self.map.render(eye=[0, 0, 30], target=np.zeros(3), width=64, height=64))
        self.assertTrue((down != self.map.render(view="map", width=64, height=64)).any())

    def test_above_a_photograph(self):
        image = self.map.render(drive=sample.drive(), frame=1)
        drive = fovea.Drive(sample.drive())
        height = drive.cameras[0].height
        self.assertEqual(image.shape, (2 * height, drive.cameras[0].width, 3))
        np.testing.assert_array_equal(image[height:], drive.load(1).images[2])
        with self.assertRaises(fovea.InputError):
            self.map.render(drive=sample.drive(), frame=sample.WITHOUT_SCAN)

    def test_errors(self):
        for options in [{"view": "below"}, {"width": 3}, {"height": 100000}, {"exposure": "dark"},
                        {"eye": (0, 0, 0), "target": (0, 0, 0)}]:
            with self.assertRaises(fovea.ConfigError, msg=str(options)):
                self.map.render(**options)
        with self.assertRaises(ValueError):
            self.map.render(eye=(0, 0, 0))
        with self.assertRaises(fovea.InputError):
            self.map.render(frame=1000)


class RenderDriveTest(unittest.TestCase):
    def setUp(self):
        self.map = fovea.Map(sample.map_file())
        self.poses = np.stack([frame.T_local_lidar for frame in self.map.frames[:2]])

    def test_a_rendered_drive_is_a_drive(self):
        camera = fovea.Drive(sample.drive()).cameras[0]
        output = sample.folder() / "rendered"
        figures = self.map.render_drive(output, self.poses, cameras={"front": camera},
                                        lidar="hdl64", rate=5)
        self.assertEqual(figures.frames, 2)
        self.assertGreater(figures.covered, 0)
        self.assertGreater(figures.points, 100)
        drive = fovea.Drive(output)
        self.assertEqual(len(drive), 2)
        self.assertEqual(drive.load(1).stamp - drive.load(0).stamp, 200_000_000)
        with self.assertRaises(fovea.OutputError):
            self.map.render_drive(output, self.poses, lidar="hdl64")

    def test_errors(self):
        output = sample.folder() / "not_rendered"
        for options in [{}, {"lidar": "hdl64", "rate": 0}, {"lidar": "hdl64", "reach": 1e6}]:
            with self.assertRaises(ValueError, msg=str(options)):
                self.map.render_drive(output, self.poses, **options)
        with self.assertRaises(ValueError):
            self.map.render_drive(output, self.poses[0], lidar="hdl64")
        with self.assertRaises(fovea.ConfigError):
            self.map.render_drive(output, self.poses, lidar="eye")
        self.assertFalse(output.exists())


class MergeTest(unittest.TestCase):
    def test_merges_parts_of_a_drive(self):
        parts = []
        for frames in [(0, 3), (3, 6)]:
            output = sample.folder() / f"part_{frames[0]}.fovea"
            fovea.map_drive(sample.drive(), output, settings=sample.SETTINGS, frames=frames)
            parts.append(output)
        mine, theirs = sample.folder() / "merged.fovea", sample.folder() / "program_merged.fovea"
        figures = fovea.merge(fovea.Map(parts[0]), parts[1], mine)
        sample.run("merge", *parts, "-o", theirs, "--quiet")
        self.assertEqual(fovea.Map(mine).digest(), fovea.Map(theirs).digest())
        self.assertEqual(figures.points, len(fovea.Map(mine)))
        self.assertEqual(figures.drives_added, 1)
        self.assertEqual(figures.log2_gain.shape, (3,))
        with self.assertRaises(fovea.OutputError):
            fovea.merge(*parts, mine)

    def test_errors(self):
        with self.assertRaises(fovea.InputError):
            fovea.merge(sample.map_file(), sample.folder() / "none.fovea",
                        sample.folder() / "no_merge.fovea")


if __name__ == "__main__":
    unittest.main()
