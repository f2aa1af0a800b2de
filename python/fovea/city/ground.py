"""Places on the ground: the transverse Mercator plane about the origin of a city, and cells in it.

The projection is that of src/fovea/geometry/city_grid.cpp: Krueger's series of order 6 about the origin's meridian,
with scale 1 there. It has no zones. 100 km from the meridian, lengths in the plane are 0.012 % too long.
"""
from __future__ import annotations

import math
from dataclasses import dataclass

_RADIUS_M = 6378137.0  # equatorial, WGS 84
_FLATTENING = 1 / 298.257223563
_ECCENTRICITY = math.sqrt(_FLATTENING * (2 - _FLATTENING))

Cell = tuple[int, int]
Point = tuple[float, float]  # x and y in the plane, m


def _series(n: float) -> list[float]:
    """Krueger's coefficients from 1 to 6 of the third flattening n (Karney 2011, equation 35)."""
    return [
        n * (n * (n * (n * (n * (31564 * n - 66675) + 34440) + 47250) - 100800) + 75600) / 151200,
        n**2 * (n * (n * ((863232 - 1983433 * n) * n + 748608) - 1161216) + 524160) / 1935360,
        n**3 * (n * (n * (670412 * n + 406647) - 533952) + 184464) / 725760,
        n**4 * (n * (6601661 * n - 7732800) + 2230245) / 7257600,
        n**5 * (3438171 - 13675556 * n) / 7983360,
        n**6 * 212378941 / 319334400,
    ]


_N = _FLATTENING / (2 - _FLATTENING)
_COEFFICIENTS = _series(_N)
_MEAN_RADIUS_M = _RADIUS_M / (1 + _N) * (1 + _N**2 / 4 + _N**4 / 64 + _N**6 / 256)


def transverse_mercator(latitude_deg: float, longitude_deg: float, meridian_deg: float) -> Point:
    """m east of the meridian and north of the equator."""
    latitude = math.radians(latitude_deg)
    longitude = math.radians(math.remainder(longitude_deg - meridian_deg, 360))
    tau = math.tan(latitude)
    sigma = math.sinh(_ECCENTRICITY * math.atanh(_ECCENTRICITY * math.sin(latitude)))
    conformal = tau * math.hypot(1, sigma) - sigma * math.hypot(1, tau)
    xi = north = math.atan2(conformal, math.cos(longitude))
    eta = east = math.asinh(math.sin(longitude) / math.hypot(conformal, math.cos(longitude)))
    for k, coefficient in enumerate(_COEFFICIENTS, start=1):
        north += coefficient * math.sin(2 * k * xi) * math.cosh(2 * k * eta)
        east += coefficient * math.cos(2 * k * xi) * math.sinh(2 * k * eta)
    return _MEAN_RADIUS_M * east, _MEAN_RADIUS_M * north


@dataclass(frozen=True)
class Place:
    """Latitude and longitude in degrees, WGS 84; height in m."""

    latitude_deg: float
    longitude_deg: float
    height_m: float = 0.0


class Plane:
    """The plane about an origin: x points east, y points north, in m."""

    def __init__(self, origin: Place) -> None:
        self.origin = origin
        self._north = transverse_mercator(origin.latitude_deg, origin.longitude_deg, origin.longitude_deg)[1]

    def project(self, place: Place) -> Point:
        """x and y of a place."""
        x, y = transverse_mercator(place.latitude_deg, place.longitude_deg, self.origin.longitude_deg)
        return x, y - self._north


def cells_within(x: float, y: float, radius: float, size: float) -> list[Cell]:
    """Cells [i, i + 1) * size by [j, j + 1) * size that are within a radius of a point. All are m in the plane."""
    radius *= math.cosh(min(abs(x) / _RADIUS_M, 5.0))  # lengths in the plane are longer far from the meridian
    cells = []
    for i in range(math.floor((x - radius) / size), math.floor((x + radius) / size) + 1):
        from_x = max(i * size - x, 0.0, x - (i + 1) * size)
        for j in range(math.floor((y - radius) / size), math.floor((y + radius) / size) + 1):
            from_y = max(j * size - y, 0.0, y - (j + 1) * size)
            if math.hypot(from_x, from_y) <= radius:
                cells.append((i, j))
    return cells
