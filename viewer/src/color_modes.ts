import { rgbOf, type ColorMapName, type Rgb } from './color_maps';
import type { MapInfo } from './protocol';

export const colorModes = [
  'photograph', 'height', 'range', 'camera', 'age', 'rule', 'views', 'error', 'zone',
] as const;
export type ColorMode = typeof colorModes[number];

/** The name in the panel, and one line on what it shows. */
export const colorModeTexts: Record<ColorMode, readonly [string, string]> = {
  photograph: ['Photograph', 'The colours that the cameras gave'],
  height: ['Height', 'Above the origin of the map'],
  range: ['Range', 'From the sensor that saw the point'],
  camera: ['Camera', 'Which camera coloured the point first'],
  age: ['Age', 'The frame that put the point into the map'],
  rule: ['Measured', 'A return of the LiDAR, or interpolated by which rule'],
  views: ['Views', 'Images whose colours agree and are fused in the point'],
  error: ['Image error', 'Against the image of the chosen frame and camera'],
  zone: ['Foveal zone', 'Nearer than the fovea, in it, or beyond it'],
};

/** A continuous scale of a mode: values from `low` to `high` over a colour map. */
export interface Ramp {
  readonly map: ColorMapName;
  readonly low: number;
  readonly high: number;
  readonly unit: string;
}

/** A kind of point, in the table at `index`. */
export interface Kind {
  readonly index: number;
  readonly name: string;
  readonly color: Rgb;
}

/** What ranges the data of this map have. */
export interface DataRanges {
  readonly height: readonly [number, number];
  readonly frame: readonly [number, number];
}

export const neutralGrey: Rgb = [0.5, 0.5, 0.5];
export const outsideGrey: Rgb = [0.32, 0.34, 0.37];

// Okabe and Ito's colours, which differ for all kinds of eyes.
const kindColors =
  [0x56b4e9, 0xe69f00, 0x009e73, 0xf0e442, 0xcc79a7, 0xd55e00, 0x0072b2].map(rgbOf);

function kind(index: number, name: string): Kind {
  return { index, name, color: kindColors[index % kindColors.length]! };
}

export function rampOf(mode: ColorMode, ranges: DataRanges): Ramp | null {
  switch (mode) {
    case 'height':
      return { map: 'turbo', low: ranges.height[0], high: ranges.height[1], unit: 'm' };
    case 'range': return { map: 'turbo', low: 0, high: 60, unit: 'm' };
    case 'age':
      return { map: 'viridis', low: ranges.frame[0], high: ranges.frame[1], unit: '(frame)' };
    case 'views': return { map: 'viridis', low: 1, high: 20, unit: 'images' };
    case 'error': return { map: 'inferno', low: 0, high: 64, unit: 'grey values' };
    default: return null;
  }
}

/** The kinds of a mode that has no scale, in the order of the legend. */
export function kindsOf(mode: ColorMode, map: MapInfo, seenCameras: ReadonlySet<number>): Kind[] {
  switch (mode) {
    case 'camera': {
      const known = new Set([...map.cameras.map((camera) => camera.index), ...seenCameras]);
      return [...known].filter((index) => index < 255).sort((a, b) => a - b)
        .map((index) => kind(index, `Camera ${index}`));
    }
    case 'rule': return map.rules.map((name, index) => kind(index, name));
    case 'zone': {
      const { near, far } = map.foveal ?? { near: 0, far: 0 };
      return [
        kind(0, `Below ${near} m`), kind(1, `${near} to ${far} m: fovea`),
        kind(2, `From ${far} m on`),
      ];
    }
    default: return [];
  }
}

/** The table of colours of kinds as the shader has it: 16 RGBA texels. */
export function kindTable(): Uint8Array<ArrayBuffer> {
  const table = new Uint8Array(4 * 16);
  for (let i = 0; i < 16; ++i) {
    const rgb = kindColors[i % kindColors.length]!.map((value) => Math.round(255 * value));
    table.set([...rgb, 255], 4 * i);
  }
  return table;
}

/** Modes that this map has data for. */
export function modesOf(map: MapInfo): ColorMode[] {
  if (map.mesh) return ['photograph'];
  return colorModes.filter((mode) => {
    if (mode === 'age') return map.city === null;  // its tiles number their frames by themselves
    if (mode === 'zone') return map.foveal !== null;
    if (mode === 'error') return map.images && map.cameras.length > 0;
    return true;
  });
}
