"""Where a drive's scans were taken in a map: localize.py DRIVE MAP.fovea"""
import sys

import fovea
import numpy as np

drive = fovea.Drive(sys.argv[1], use_images=False)
localizer = fovea.Localizer(sys.argv[2], drive)
for frame in drive:
    place = localizer.localize(frame)
    if place.T_local_lidar is None or place.covariance is None:
        print(f"frame {place.index}: {place.state}")
        continue
    x, y, z = place.T_local_lidar[:3, 3]
    sigma = np.sqrt(np.trace(place.covariance[3:, 3:]))
    print(f"frame {place.index}: {x:.2f} {y:.2f} {z:.2f} m, +-{sigma:.3f} m, "
          f"health {place.health:.2f}")
