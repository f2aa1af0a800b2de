import { expect, test } from 'vitest';

import { stagesOf } from './live_stages';
import type { Frame } from './protocol';

function frame(milliseconds: Record<string, number>): Frame {
  return { index: 0, time: 0, status: 'mapped', T_local_lidar: [], score: null, milliseconds };
}

test('what the stages leave of a frame is the rest', () => {
  expect(stagesOf(frame({ frame: 90, register: 30, texture: 20 }))).toEqual([
    { stage: 'register', milliseconds: 30 }, { stage: 'texture', milliseconds: 20 },
    { stage: 'rest', milliseconds: 40 },
  ]);
});

test('stages that overlap leave no rest', () => {
  expect(stagesOf(frame({ frame: 40, register: 30, texture: 20 })).map(({ stage }) => stage))
    .toEqual(['register', 'texture']);
  expect(stagesOf(frame({}))).toEqual([]);
});
