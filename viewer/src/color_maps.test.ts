import { expect, test } from 'vitest';

import { colorMapNames, colorOf, colorTable } from './color_maps';

test('viridis is the one of the literature at its ends', () => {
  const [first, last] = [colorOf('viridis', 0), colorOf('viridis', 1)];
  [0.267, 0.005, 0.329].forEach((value, i) => expect(first[i]).toBeCloseTo(value, 1));
  [0.993, 0.906, 0.144].forEach((value, i) => expect(last[i]).toBeCloseTo(value, 1));
});

test('no map leaves its range, wherever one looks', () => {
  for (const map of colorMapNames) {
    for (const x of [-1, 0, 0.1, 0.5, 0.99, 1, 2]) {
      for (const value of colorOf(map, x)) {
        expect(value).toBeGreaterThanOrEqual(0);
        expect(value).toBeLessThanOrEqual(1);
      }
    }
  }
});

test('the table has a row a map', () => {
  expect(colorTable(16)).toHaveLength(4 * 16 * colorMapNames.length);
});
