import { Vector3 } from 'three';
import { describe, expect, test } from 'vitest';

import { ecefOf, geodeticOf, geodeticOfEnu } from './geodesy';

describe('WGS 84', () => {
  test('the axes of the ellipsoid', () => {
    expect(ecefOf({ latitude: 0, longitude: 0, altitude: 0 }).x).toBe(6378137);
    expect(ecefOf({ latitude: 90, longitude: 0, altitude: 0 }).z).toBeCloseTo(6356752.314245, 5);
  });

  test('a known place: 45 N 45 E, 1000 m', () => {
    // N = a / sqrt(1 - e2/2) = 6388838.290121; x = y = (N + h)/2, z = (N (1 - e2) + h) / sqrt 2.
    const p = ecefOf({ latitude: 45, longitude: 45, altitude: 1000 });
    expect(p.x).toBeCloseTo(3194919.14506, 4);
    expect(p.y).toBeCloseTo(3194919.14506, 4);
    expect(p.z).toBeCloseTo(4488055.5157, 3);
  });

  test('there and back again', () => {
    for (const latitude of [-89.9, -33.3, 0, 49.011212, 75]) {
      for (const altitude of [-100, 0, 112.8, 9000]) {
        const back = geodeticOf(ecefOf({ latitude, longitude: 8.4, altitude }));
        expect(back.latitude).toBeCloseTo(latitude, 10);
        expect(back.longitude).toBeCloseTo(8.4, 10);
        expect(back.altitude).toBeCloseTo(altitude, 5);
      }
    }
  });
});

describe('east, north, up', () => {
  const origin = { latitude: 49, longitude: 8.4, altitude: 100 };

  test('the origin is itself', () => {
    const at = geodeticOfEnu(origin, new Vector3());
    expect(at.latitude).toBeCloseTo(49, 11);
    expect(at.altitude).toBeCloseTo(100, 6);
  });

  test('up is up, a minute of latitude is about 1853.3 m, east falls off the curve', () => {
    expect(geodeticOfEnu(origin, new Vector3(0, 0, 50)).altitude).toBeCloseTo(150, 6);
    const north = geodeticOfEnu(origin, new Vector3(0, 1853.32, 0));
    expect((north.latitude - 49) * 60).toBeCloseTo(1, 3);
    const east = geodeticOfEnu(origin, new Vector3(1000, 0, 0));
    // A kilometre on the tangent plane is d^2 / 2N above the ellipsoid.
    expect(east.altitude - 100).toBeCloseTo(1e6 / 2 / 6390324, 3);
    expect(east.longitude).toBeGreaterThan(8.4);
  });
});
