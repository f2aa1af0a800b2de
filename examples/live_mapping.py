"""Maps while sensors measure: live_mapping.py DRIVE MAP.fovea. A drive stands for the robot."""
import csv
import pathlib
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import fovea

folder, output = map(pathlib.Path, sys.argv[1:])
robot = fovea.Drive(folder, use_navigation=False)  # yours: the sensors of a robot
started, first = time.monotonic(), robot.load(0).stamp


def wait_until(stamp: int) -> None:
    time.sleep(max(0.0, (stamp - first) / 1e9 - (time.monotonic() - started)))


def send_scans_and_images() -> None:
    for frame in robot:
        wait_until(frame.stamp)
        mapper.add_scan(frame.stamp, frame.points, intensity=frame.intensity, times=frame.time)
        if 2 in frame.images:
            mapper.add_image("camera_2", frame.stamp, frame.images[2])


def send_positions() -> None:
    for stamp, *numbers in list(csv.reader((folder / "gnss.csv").open()))[1:]:
        wait_until(int(stamp))
        latitude, longitude, altitude, accuracy, *angles = map(float, numbers[:7])
        mapper.add_position(int(stamp), latitude, longitude, altitude, accuracy=accuracy,
                            roll_pitch_yaw=angles)


with fovea.LiveMapper(folder / "drive.toml", output, expects_navigation=True,
                      on_pose=lambda pose: print(pose.index, pose.state)) as mapper:
    with ThreadPoolExecutor() as threads:
        for sensor in [threads.submit(send) for send in (send_scans_and_images, send_positions)]:
            sensor.result()
print(f"{mapper.close()['points']} points, {mapper.figures}")
