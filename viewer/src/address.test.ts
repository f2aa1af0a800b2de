import { describe, expect, test } from 'vitest';

import { hashOf, stateOf } from './address';

describe('a link', () => {
  test('brings back what it was made of', () => {
    const state = {
      at: [1.5, -2, 3] as const, to: [11, -2.125, 2] as const, frame: 12, mode: 'height' as const,
      navigation: 'fly' as const, camera: 2, show: ['trajectory', 'rays'],
      line: [[0, 0, 0], [1, 2, 3]] as const,
    };
    expect(stateOf(hashOf(state))).toEqual(state);
  });

  test('keeps millimetres', () => {
    expect(stateOf(hashOf({ at: [1234.56789, 0, 0] })).at).toEqual([1234.568, 0, 0]);
  });

  test('knows that nothing is shown from that nothing is said', () => {
    expect(stateOf(hashOf({ show: [] })).show).toEqual([]);
    expect(stateOf('').show).toBeUndefined();
  });

  test('with nonsense in it brings back the rest', () => {
    const hash = '#at=1,2&to=a,b,c&frame=x&mode=purple&move=swim&line=1,2,3;4&camera=2&what=ever';
    expect(stateOf(hash)).toEqual({ camera: 2 });
    expect(stateOf('#%%%')).toEqual({});
    expect(stateOf('#at=1,,3').at).toBeUndefined();
  });
});
