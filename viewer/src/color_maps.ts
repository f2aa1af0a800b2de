// Colour maps of the literature as polynomials: one place for the shader's table and the legends.

export type Rgb = readonly [number, number, number];
export type ColorMapName = 'turbo' | 'viridis' | 'inferno';

/** Coefficients of 1, x, x^2 ... for red, green, blue. Viridis and inferno after M. Zucker's fit of
 * matplotlib's tables, turbo after A. Mikhailov's. */
const polynomials: Record<ColorMapName, readonly Rgb[]> = {
  turbo: [
    [0.13572138, 0.09140261, 0.1066733],
    [4.6153926, 2.19418839, 12.64194608],
    [-42.66032258, 4.84296658, -60.58204836],
    [132.13108234, -14.18503333, 110.36276771],
    [-152.94239396, 4.27729857, -89.90310912],
    [59.28637943, 2.82956604, 27.34824973],
  ],
  viridis: [
    [0.27772733, 0.00540734, 0.33409981],
    [0.10509304, 1.40461353, 1.38459016],
    [-0.33086183, 0.21484756, 0.09509516],
    [-4.6342305, -5.79910097, -19.33244096],
    [6.22826994, 14.17993337, 56.6905526],
    [4.776385, -13.74514538, -65.35303263],
    [-5.43545586, 4.64585261, 26.31243525],
  ],
  inferno: [
    [0.00021894, 0.001651, -0.0194809],
    [0.10651342, 0.56395644, 3.93271239],
    [11.60249308, -3.97285397, -15.94239411],
    [-41.70399613, 17.43639888, 44.3541452],
    [77.1629357, -33.40235894, -81.80730926],
    [-71.31942824, 32.62606426, 73.20951986],
    [25.13112622, -12.24266895, -23.070325],
  ],
};

export const colorMapNames = Object.keys(polynomials) as ColorMapName[];

/** `x` from 0 to 1; channels from 0 to 1. */
export function colorOf(map: ColorMapName, x: number): Rgb {
  const at = Math.min(1, Math.max(0, x));
  const channel = (i: 0 | 1 | 2) => {
    const value = polynomials[map].reduceRight((sum, row) => sum * at + row[i], 0);
    return Math.min(1, Math.max(0, value));
  };
  return [channel(0), channel(1), channel(2)];
}

/** All maps as rows of one RGBA table, `width` texels each. */
export function colorTable(width: number): Uint8Array<ArrayBuffer> {
  const table = new Uint8Array(4 * width * colorMapNames.length);
  colorMapNames.forEach((name, row) => {
    for (let i = 0; i < width; ++i) {
      const rgb = colorOf(name, i / (width - 1)).map((value) => Math.round(255 * value));
      table.set([...rgb, 255], 4 * (row * width + i));
    }
  });
  return table;
}

export function cssGradient(map: ColorMapName): string {
  const stops = Array.from({ length: 17 }, (_, i) => cssColor(colorOf(map, i / 16)));
  return `linear-gradient(90deg, ${stops.join(', ')})`;
}

export function cssColor(rgb: Rgb): string {
  return `rgb(${rgb.map((value) => Math.round(255 * value)).join(' ')})`;
}

export function rgbOf(hex: number): Rgb {
  return [(hex >> 16 & 255) / 255, (hex >> 8 & 255) / 255, (hex & 255) / 255];
}
