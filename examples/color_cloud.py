"""Colors the scan of a frame by all cameras, and writes x y z r g b: color_cloud.py DRIVE FRAME OUT.txt"""
import sys

import fovea
import numpy as np

folder, number, output = sys.argv[1:]
drive = fovea.Drive(folder)
frame = drive[int(number)]
color = np.zeros((len(frame.points), 3), np.uint8)
is_colored = np.zeros(len(frame.points), bool)
for camera in drive.cameras:
    image = frame.images.get(camera.index)
    if image is None:
        continue
    camera = camera.at_image(frame.motion)  # where it was when it took the image
    points_cam = frame.points @ camera.T_cam_lidar[:3, :3].T + camera.T_cam_lidar[:3, 3]
    seen = fovea.color_points(points_cam, image, camera)
    color[seen.is_seen] = seen.color[seen.is_seen]
    is_colored |= seen.is_seen
np.savetxt(output, np.hstack([frame.points, color])[is_colored], "%.3f %.3f %.3f %d %d %d")
print(f"{is_colored.sum()} of {len(frame.points)} points have a color")
