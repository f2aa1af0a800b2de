"""Heights and colors of a map: read_map.py MAP.fovea"""
import sys

import fovea
import numpy as np

city = fovea.Map(sys.argv[1])
print(f"{city.size} points from {len(city.frames)} frames, {len(city.tiles())} tiles")

points = city.points(where="views >= 2")  # frame `local`, m; "" for all
low, median, high = np.percentile(points.position[:, 2], [5, 50, 95])
red, green, blue = points.color.mean(axis=0)
print(f"{len(points)} seen twice: heights {low:.2f} {median:.2f} {high:.2f} m, "
      f"mean color {red:.0f} {green:.0f} {blue:.0f}")

# A tile at a time, for maps that are larger than the memory; in the frames of their submaps.
T_local_submap = city.submaps
for (submap, *key), tile in city:
    p_submap = tile.origin + tile.position
    p_local = p_submap @ T_local_submap[submap, :3, :3].T + T_local_submap[submap, :3, 3]
    assert p_local.shape == (len(tile), 3)
