import { expect, test } from 'vitest';

import { estimatedSpacing } from './spacing';

test('points in rows on a plane are as far apart as they are', () => {
  const side = 100;
  const step = 0.02;
  const at = (i: number, axis: number) =>
    (axis === 0 ? (i % side) * step : axis === 1 ? Math.floor(i / side) * step : 0);
  expect(estimatedSpacing(side * side, at, 1, 0.25)).toBeCloseTo(step, 2);
});

test('few points are not a cell apart or more', () => {
  expect(estimatedSpacing(1, () => 0, 1, 0.25)).toBe(0.25);
  expect(estimatedSpacing(3, (i) => 10 * i, 1, 0.25)).toBe(0.25);
});
