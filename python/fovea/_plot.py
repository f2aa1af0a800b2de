"""A map from above, as a picture of NumPy and as a plot of matplotlib."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Tuple

import numpy as np
import numpy.typing as npt

from ._extras import load

if TYPE_CHECKING:
    from ._map import Points

_MAX_PIXELS = 50_000_000

Extent = Tuple[float, float, float, float]


def top_picture(points: Points, pixel: float) -> Tuple[npt.NDArray[np.uint8], Extent]:
    """The highest point in each pixel, white where there is none.

    pixel: edge of a pixel, m. Returns height x width x 3 colors, north up, and the borders of the
    picture: left, right, bottom, top, m. ValueError for no points and for too many pixels.
    """
    if not pixel > 0:
        raise ValueError("pixel is not above 0")
    if len(points) == 0:
        raise ValueError("there are no points to draw")
    xyz = points.xyz
    left, bottom = np.floor(xyz[:, :2].min(axis=0) / pixel)
    right, top = np.floor(xyz[:, :2].max(axis=0) / pixel) + 1
    if (right - left) * (top - bottom) > _MAX_PIXELS:
        raise ValueError(f"the picture has over {_MAX_PIXELS} pixels: give a larger pixel or a box")
    column = (np.floor(xyz[:, 0] / pixel) - left).astype(int)
    row = (top - 1 - np.floor(xyz[:, 1] / pixel)).astype(int)
    upward = np.argsort(xyz[:, 2], kind="stable")  # the last point of a pixel stays: the highest
    picture = np.full((int(top - bottom), int(right - left), 3), 255, np.uint8)
    picture[row[upward], column[upward]] = points.color[upward]
    return picture, (left * pixel, right * pixel, bottom * pixel, top * pixel)


def plot_top(points: Points, ax: Any, pixel: float) -> Any:
    """Map.plot_top()."""
    pyplot = load("matplotlib.pyplot", "plot") if ax is None else None
    picture, extent = top_picture(points, pixel)
    if pyplot is not None:
        ax = pyplot.subplots()[1]
    ax.imshow(picture, extent=extent, origin="upper", interpolation="nearest")
    ax.set_aspect("equal")
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")
    return ax
