"""How the LiDAR moved between two frames of a drive: register_scans.py DRIVE FIRST SECOND"""
import sys

import fovea
import numpy as np

drive = fovea.Drive(sys.argv[1], use_images=False)
first, second = (drive[int(number)] for number in sys.argv[2:])
result = fovea.register_scans(first.points, second.points, max_distance=2.0, robust_width=0.1,
                              max_points=20000)
x, y, z = result.T_target_source[:3, 3]
turned = np.degrees(np.arccos(min(1.0, (np.trace(result.T_target_source[:3, :3]) - 1) / 2)))
print(f"moved {x:.3f} {y:.3f} {z:.3f} m, turned {turned:.2f} degrees; {result.pairs} pairs, "
      f"{result.rms_distance:.3f} m apart{'' if result.converged else ' (not converged)'}")
