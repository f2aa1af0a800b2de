import type { PickedPoint } from './picking';
import type { MapInfo } from './protocol';

/** What a point carries besides position and colour; null: unknown. */
export interface PointFacts {
  readonly color: readonly [number, number, number];
  readonly frame: number | null;
  readonly camera: number | null;
  readonly range: number | null;
  readonly incidence: number | null;
  readonly rule: string | null;
  readonly interpolated: boolean | null;
  readonly matched: boolean;
  readonly views: number | null;
  readonly spread: number | null;
}

const unknown = 65535;
const uncolored = 255;

function srgbOfLinear(x: number): number {
  const s = x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
  return Math.round(255 * s);
}

export function factsOf({ object, index }: PickedPoint, map: MapInfo): PointFacts {
  const { geometry } = object;
  const color = geometry.getAttribute('color');
  const encode = object.linear ? srgbOfLinear : (x: number) => Math.round(255 * x);
  const rgb: [number, number, number] =
    [encode(color.getX(index)), encode(color.getY(index)), encode(color.getZ(index))];
  if (!object.known) {
    return {
      color: rgb, frame: null, camera: null, range: null, incidence: null, rule: null,
      interpolated: null, matched: false, views: null, spread: null,
    };
  }
  const sight = geometry.getAttribute('_sight');
  const source = geometry.getAttribute('_source');
  const camera = source.getX(index);
  const bits = source.getY(index);
  const centimetres = sight.getX(index);
  const hundredths = sight.getY(index);
  return {
    color: rgb,
    // The tiles of a city number their frames by themselves.
    frame: map.city ? null : geometry.getAttribute('_frame').getX(index),
    camera: camera === uncolored ? null : camera,
    range: centimetres === unknown ? null : centimetres / 100,
    incidence: hundredths === unknown ? null : hundredths / 100,
    rule: map.rules[bits & 15] ?? null,
    interpolated: (bits & 0x80) !== 0,
    matched: (bits & 0x10) !== 0,
    views: camera === uncolored ? null : source.getZ(index),
    spread: camera === uncolored ? null : source.getW(index),
  };
}
