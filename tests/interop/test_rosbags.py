"""Recordings that rosbags writes give the map of the drive that was recorded."""
import pathlib
import unittest

import rosbags.rosbag1
import rosbags.rosbag2
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin

import recording
import sample


def write_ros2(path: pathlib.Path, plugin: StoragePlugin, compression: CompressionMode) -> None:
    store = recording.ROS2
    writer = rosbags.rosbag2.Writer(path, version=9, storage_plugin=plugin)
    if compression != CompressionMode.NONE:
        writer.set_compression(compression, CompressionFormat.ZSTD)
    connections = {}
    with writer:
        for recorded in recording.Vehicle(sample.recorded_drive(), store).messages():
            if recorded.topic not in connections:
                connections[recorded.topic] = writer.add_connection(recorded.topic, recorded.type, typestore=store)
            data = store.serialize_cdr(recorded.message, recorded.type)
            writer.write(connections[recorded.topic], recorded.time, data)


def write_ros1(path: pathlib.Path, compression: rosbags.rosbag1.Writer.CompressionFormat | None) -> None:
    store = recording.ROS1
    writer = rosbags.rosbag1.Writer(path)
    if compression:
        writer.set_compression(compression)
    connections = {}
    with writer:
        for recorded in recording.Vehicle(sample.recorded_drive(), store).messages():
            if recorded.topic not in connections:
                connections[recorded.topic] = writer.add_connection(recorded.topic, recorded.type, typestore=store)
            data = store.serialize_ros1(recorded.message, recorded.type)
            writer.write(connections[recorded.topic], recorded.time, data)


class RosbagsTest(unittest.TestCase):
    def check(self, path: pathlib.Path) -> None:
        converted = sample.folder() / f"from_{path.name}" / "drive"
        converted.parent.mkdir()
        sample.run("convert", path, "-o", converted, "--quiet")
        self.assertEqual(sample.digest(converted), sample.digest(sample.recorded_drive()))

    def test_ros2(self):
        for plugin in StoragePlugin:
            for mode in (CompressionMode.NONE, CompressionMode.MESSAGE, CompressionMode.FILE):
                with self.subTest(plugin=plugin.name, mode=mode.name):
                    path = sample.folder() / f"{plugin.name}_{mode.name}"
                    write_ros2(path, plugin, mode)
                    self.check(path)

    def test_an_mcap_file_alone(self):
        path = sample.folder() / "alone"
        write_ros2(path, StoragePlugin.MCAP, CompressionMode.NONE)
        self.check(next(path.glob("*.mcap")))

    def test_ros1(self):
        for compression in (None, *rosbags.rosbag1.Writer.CompressionFormat):
            with self.subTest(compression=compression):
                path = sample.folder() / f"ros1_{compression.name if compression else 'NONE'}.bag"
                write_ros1(path, compression)
                self.check(path)


if __name__ == "__main__":
    unittest.main()
