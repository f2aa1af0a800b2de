"""A drive as the messages that a vehicle with ROS would have recorded, written by rosbags."""
import csv
import dataclasses
import inspect
import itertools
import pathlib
import tomllib
from typing import Any, Iterator

import numpy as np
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore
from scipy.spatial.transform import Rotation

ROS1 = get_typestore(Stores.ROS1_NOETIC)
ROS1.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
ROS2 = get_typestore(Stores.ROS2_HUMBLE)
MILLISECOND = 1_000_000  # ns
FLOAT32 = 7  # PointField.FLOAT32


@dataclasses.dataclass
class Recorded:
    """A message, and when it was recorded."""

    topic: str
    type: str
    time: int  # ns
    message: Any


def read_table(path: pathlib.Path) -> list[dict[str, str]]:
    with path.open() as file:
        return list(csv.DictReader(file))


def stamped_files(folder: pathlib.Path) -> Iterator[tuple[int, pathlib.Path]]:
    files = {int(path.stem): path for path in folder.glob("[0-9]*")}
    return ((int(row["time_ns"]), files[int(row["index"])]) for row in read_table(folder / "stamps.csv"))


def write_poses(drive: pathlib.Path) -> None:
    """The true poses as poses.csv, in place of gnss.csv."""
    T = tomllib.loads((drive / "drive.toml").read_text())["body"]["T_body_lidar"]
    R_lidar_body = Rotation.from_quat(T["rotation"]).inv()
    lines = ["time_ns,x,y,z,qx,qy,qz,qw"]
    truth = np.loadtxt(drive / "truth" / "poses.txt").reshape(-1, 3, 4)
    for (stamp, _), pose in zip(stamped_files(drive / "lidar"), truth):
        rotation = Rotation.from_matrix(pose[:, :3]) * R_lidar_body
        place = pose[:, 3] - rotation.apply(T["translation"])
        lines.append(",".join([str(stamp), *map(repr, map(float, (*place, *rotation.as_quat())))]))
    (drive / "poses.csv").write_text("\n".join(lines) + "\n")
    (drive / "gnss.csv").unlink()


class Vehicle:
    """Encodes the files of a drive as messages of one version of ROS."""

    def __init__(self, drive: pathlib.Path, store: Typestore) -> None:
        self.drive = drive
        self.store = store
        self.tables = tomllib.loads((drive / "drive.toml").read_text())

    def make(self, name: str, /, **fields: Any) -> Any:
        """A message; fields that it lacks in this version of ROS are left out."""
        kind = self.store.types[name]
        names = inspect.signature(kind).parameters
        return kind(**{key: value for key, value in fields.items() if key in names})

    def header(self, time: int, frame: str) -> Any:
        second, nanosecond = divmod(time, 1_000_000_000)
        stamp = self.make("builtin_interfaces/msg/Time", sec=second, nanosec=nanosecond)
        return self.make("std_msgs/msg/Header", seq=0, stamp=stamp, frame_id=frame)

    def vector(self, values: Any, kind: str = "Vector3") -> Any:
        return self.make(f"geometry_msgs/msg/{kind}", **dict(zip("xyzw", map(float, values))))

    def transform(self, time: int, parent: str, child: str, T: dict[str, Any]) -> Any:
        motion = self.make("geometry_msgs/msg/Transform", translation=self.vector(T["translation"]),
                           rotation=self.vector(T["rotation"], "Quaternion"))
        return self.make("geometry_msgs/msg/TransformStamped", header=self.header(time, parent),
                         child_frame_id=child, transform=motion)

    def scan(self, time: int, path: pathlib.Path) -> Any:
        head, data = path.read_bytes().split(b"DATA binary\n", 1)
        values = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines()}
        names, count = values["FIELDS"], int(values["POINTS"][0])
        fields = [self.make("sensor_msgs/msg/PointField", name=name, offset=4 * i, datatype=FLOAT32, count=1)
                  for i, name in enumerate(names)]
        step = 4 * len(names)
        return self.make("sensor_msgs/msg/PointCloud2", header=self.header(time, "velodyne"), height=1, width=count,
                         fields=fields, is_bigendian=False, point_step=step, row_step=step * count,
                         data=np.frombuffer(data, np.uint8), is_dense=True)

    def camera_info(self, time: int, name: str) -> Any:
        camera = self.tables["camera"][name]
        K = np.array(camera["K"], np.float64)
        P = np.column_stack([K.reshape(3, 3), np.zeros(3)]).ravel()
        matrices = {"k": K, "d": np.zeros(5), "r": np.eye(3).ravel(), "p": P}
        region = self.make("sensor_msgs/msg/RegionOfInterest", x_offset=0, y_offset=0, height=0, width=0,
                           do_rectify=False)
        return self.make("sensor_msgs/msg/CameraInfo", header=self.header(time, f"{name}_optical"),
                         height=camera["height"], width=camera["width"], distortion_model="plumb_bob",
                         binning_x=0, binning_y=0, roi=region,
                         **matrices, **{key.upper(): value for key, value in matrices.items()})

    def scans(self) -> Iterator[Recorded]:
        for time, path in stamped_files(self.drive / "lidar"):
            yield Recorded("/points", "sensor_msgs/msg/PointCloud2", time + 60 * MILLISECOND, self.scan(time, path))

    def images(self) -> Iterator[Recorded]:
        for name in self.tables["camera"]:
            for time, path in stamped_files(self.drive / "images" / name):
                image = self.make("sensor_msgs/msg/CompressedImage", header=self.header(time, f"{name}_optical"),
                                  format="rgb8; png compressed bgr8", data=np.frombuffer(path.read_bytes(), np.uint8))
                yield Recorded(f"/{name}/camera_info", "sensor_msgs/msg/CameraInfo", time + 24 * MILLISECOND,
                               self.camera_info(time, name))
                yield Recorded(f"/{name}/image_raw/compressed", "sensor_msgs/msg/CompressedImage",
                               time + 25 * MILLISECOND, image)

    def places(self) -> Iterator[Recorded]:
        time = next(stamped_files(self.drive / "lidar"))[0]
        transforms = [self.transform(time, "base_link", "velodyne", self.tables["body"]["T_body_lidar"])]
        transforms += [self.transform(time, "velodyne", f"{name}_optical", camera["T_lidar_cam"])
                       for name, camera in self.tables["camera"].items()]
        yield Recorded("/tf_static", "tf2_msgs/msg/TFMessage", time + 110 * MILLISECOND,
                       self.make("tf2_msgs/msg/TFMessage", transforms=transforms))

    def poses(self) -> Iterator[Recorded]:
        covariance = np.zeros(36)
        zero = self.make("geometry_msgs/msg/Twist", linear=self.vector([0, 0, 0]), angular=self.vector([0, 0, 0]))
        twist = self.make("geometry_msgs/msg/TwistWithCovariance", twist=zero, covariance=covariance)
        for row in read_table(self.drive / "poses.csv"):
            time = int(row["time_ns"])
            pose = self.make("geometry_msgs/msg/Pose", position=self.vector([row[axis] for axis in "xyz"], "Point"),
                             orientation=self.vector([row[f"q{axis}"] for axis in "xyzw"], "Quaternion"))
            uncertain = self.make("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=covariance)
            message = self.make("nav_msgs/msg/Odometry", header=self.header(time, "map"), child_frame_id="base_link",
                                pose=uncertain, twist=twist)
            yield Recorded("/odom", "nav_msgs/msg/Odometry", time + 3 * MILLISECOND, message)

    def messages(self) -> list[Recorded]:
        """All of them, in the order of their recording."""
        return sorted(itertools.chain(self.scans(), self.images(), self.places(), self.poses()),
                      key=lambda recorded: recorded.time)
