"""What the sensors of a small simulated vehicle send: as arrays, and as a drive."""
import functools
import itertools
import pathlib
import threading

import fovea
import numpy as np

import sample

FRAMES = 14
CAMERA = "camera_2"


@functools.lru_cache(maxsize=None)
def simulated() -> pathlib.Path:
    path = sample.folder() / "live_simulated"
    settings = ["camera.numbers=[2]", "camera.width=414", "camera.height=125", "camera.focal=240.5",
                "camera.cx=203.2", "camera.cy=57.6"]
    sample.run("simulate", "-o", path, "--format", "generic", "--frames", FRAMES, "--quiet",
               *(word for setting in settings for word in ("--set", setting)))
    return path


@functools.lru_cache(maxsize=None)
def frames():
    return list(fovea.Drive(simulated()))


@functools.lru_cache(maxsize=None)
def true_poses():
    """T_world_lidar of each frame."""
    poses = np.loadtxt(simulated() / "truth" / "poses.txt").reshape(-1, 3, 4)
    return [np.vstack([pose, [0, 0, 0, 1]]) for pose in poses]


@functools.lru_cache(maxsize=None)
def drive() -> pathlib.Path:
    """A drive of the arrays that feed() sends."""
    path = sample.folder() / "live_drive"
    camera = fovea.Drive(simulated()).cameras[0]
    T_lidar_cam = np.linalg.inv(camera.T_cam_lidar)
    model = fovea.CameraModel(camera.width, camera.height, camera.K, T_lidar_cam)
    with fovea.DriveWriter(path, cameras={CAMERA: model}) as writer:
        for frame, pose in zip(frames(), true_poses()):
            writer.add(frame.points, frame.stamp, intensity=frame.intensity, times=frame.time,
                       images={CAMERA: frame.images[2]}, T_world_lidar=pose)
    return path


def sensors(mapper, begin=0, end=FRAMES):
    """A function for each sensor, which sends its data."""
    sent = frames()[begin:end]

    def send_scans():
        for frame in sent:
            mapper.add_scan(frame.stamp, frame.points, intensity=frame.intensity, times=frame.time)

    def send_images():
        for frame in sent:
            mapper.add_image(CAMERA, frame.stamp, frame.images[2])

    def send_poses():
        for frame, pose in zip(sent, true_poses()[begin:end]):
            mapper.add_pose(frame.stamp, pose)

    return [send_scans, send_images, send_poses]


def feed(mapper, begin=0, end=FRAMES):
    """Sends the frames, each sensor from a thread of its own."""
    threads = [threading.Thread(target=send) for send in sensors(mapper, begin, end)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def mapper(output, **keywords):
    """Nothing is late for it, however slow the machine is."""
    return fovea.LiveMapper(drive(), sample.folder() / output,
                            **{"settings": sample.SETTINGS, "every_frame": True, "max_wait": 60,
                               "expects_navigation": True, "force": True, **keywords})


def feed_until_error(test, live, error):
    """Sends the frames from this thread, until the map has failed."""
    with test.assertRaises(error):
        for number in itertools.count():
            frame = frames()[number % FRAMES]
            stamp = frames()[0].stamp + number * 10 ** 8
            live.add_pose(stamp, np.eye(4))
            live.add_image(CAMERA, stamp, frame.images[2])
            live.add_scan(stamp, frame.points, times=frame.time)
