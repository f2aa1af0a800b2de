"""How the LiDAR moved between two frames of a drive: register_scans.py DRIVE FIRST SECOND"""
import sys

import fovea
import numpy as np

drive = fovea.Drive(sys.argv[1], use_images=False)
first, second = (drive[int(number)] for number in sys.argv[2:])
result = fovea.register_scans(first.points, second.points)
T = result.T_target_source
turned = np.degrees(np.arccos(min(1.0, (np.trace(T[:3, :3]) - 1) / 2)))
print(f"moved {T[0, 3]:.3f} {T[1, 3]:.3f} {T[2, 3]:.3f} m, turned {turned:.2f} degrees")

fit = fovea.scan_fit(first.points, second.points, T)
if not fit.shows_one_place:
    sys.exit(f"the scans do not fit: {fit.overlap:.0%} of the second one's walls meet the first one's, "
             f"{fit.on_plane:.0%} of these lie on them")
