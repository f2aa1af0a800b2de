import { Matrix3, Vector3 } from 'three';

import type { GeodeticPoint } from './protocol';

// WGS 84.
const semiMajor = 6378137;
const flattening = 1 / 298.257223563;
const e2 = flattening * (2 - flattening);
const semiMinor = semiMajor * (1 - flattening);
const degree = Math.PI / 180;

export function ecefOf(point: GeodeticPoint): Vector3 {
  const [lat, lon] = [point.latitude * degree, point.longitude * degree];
  const n = semiMajor / Math.sqrt(1 - e2 * Math.sin(lat) ** 2);
  return new Vector3(
    (n + point.altitude) * Math.cos(lat) * Math.cos(lon),
    (n + point.altitude) * Math.cos(lat) * Math.sin(lon),
    (n * (1 - e2) + point.altitude) * Math.sin(lat));
}

/** Bowring's first guess, then fixed-point steps: below a micrometre near the ground. */
export function geodeticOf(ecef: Vector3): GeodeticPoint {
  const p = Math.hypot(ecef.x, ecef.y);
  const theta = Math.atan2(ecef.z * semiMajor, p * semiMinor);
  let lat = Math.atan2(
    ecef.z + e2 / (1 - e2) * semiMinor * Math.sin(theta) ** 3,
    p - e2 * semiMajor * Math.cos(theta) ** 3);
  let n = semiMajor;
  for (let i = 0; i < 3; ++i) {
    n = semiMajor / Math.sqrt(1 - e2 * Math.sin(lat) ** 2);
    lat = Math.atan2(ecef.z + e2 * n * Math.sin(lat), p);
  }
  const [sin, cos] = [Math.sin(lat), Math.cos(lat)];
  const altitude = p * cos + ecef.z * sin - semiMajor * Math.sqrt(1 - e2 * sin * sin);
  return { latitude: lat / degree, longitude: Math.atan2(ecef.y, ecef.x) / degree, altitude };
}

/** East, north and up of the origin to latitude, longitude and height above the ellipsoid. */
export function geodeticOfEnu(origin: GeodeticPoint, enu: Vector3): GeodeticPoint {
  const [lat, lon] = [origin.latitude * degree, origin.longitude * degree];
  const [sinLat, cosLat] = [Math.sin(lat), Math.cos(lat)];
  const [sinLon, cosLon] = [Math.sin(lon), Math.cos(lon)];
  const R_ecef_enu = new Matrix3(
    -sinLon, -sinLat * cosLon, cosLat * cosLon,
    cosLon, -sinLat * sinLon, cosLat * sinLon,
    0, cosLat, sinLat);
  return geodeticOf(enu.clone().applyMatrix3(R_ecef_enu).add(ecefOf(origin)));
}
