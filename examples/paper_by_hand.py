"""The paper's steps on one frame: paper_by_hand.py DRIVE FRAME"""
import sys

import fovea

drive = fovea.Drive(sys.argv[1])
frame = drive[int(sys.argv[2])]
camera = drive.cameras[0]

# Deskew, by the motion that navigation measured.
scan = frame.points
if frame.motion is not None and not drive.is_compensated:
    scan = fovea.compensate_sweep(scan, frame.motion, times=frame.time, sweep=drive.sweep)
# The foveal region, and points between those of the scan.
foveal = fovea.foveal_points(scan, fovea.FovealRegion(camera))
dense = fovea.upsample(foveal, camera, rate=3, max_edge=0.3).position
# The ray filter: which points does the camera see?
verdicts = fovea.ray_filter(dense, camera, window=9)
visible = dense[verdicts == fovea.RayVerdict.VISIBLE]
# Color from the image.
color, is_seen = fovea.color_points(visible, frame.images[camera.index], camera)
print(f"{len(scan)} points of the scan, {len(foveal)} in the foveal region, {len(dense)} upsampled, "
      f"{is_seen.sum()} visible, mean color {color[is_seen].mean(axis=0).round()}")
