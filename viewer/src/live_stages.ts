import type { Frame } from './protocol';

/** A stage of a frame in a bar: `rest` is what the frame took beside its named stages. */
export interface StageTime {
  readonly stage: string;
  readonly milliseconds: number;
}

/** `frame` is the whole; stages overlap from frame to frame and may sum up to more. */
export function stagesOf(frame: Frame): StageTime[] {
  const stages = Object.entries(frame.milliseconds)
    .filter(([stage]) => stage !== 'frame')
    .map(([stage, milliseconds]) => ({ stage, milliseconds }));
  const whole = frame.milliseconds.frame;
  const sum = stages.reduce((total, { milliseconds }) => total + milliseconds, 0);
  if (whole !== undefined && whole > sum) stages.push({ stage: 'rest', milliseconds: whole - sum });
  return stages;
}
