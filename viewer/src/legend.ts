import { cssColor, cssGradient } from './color_maps';
import {
  kindsOf, neutralGrey, outsideGrey, rampOf, type ColorMode, type DataRanges,
} from './color_modes';
import { el } from './dom';
import type { MapInfo } from './protocol';

function number(value: number): string {
  return Math.abs(value) >= 100 || Number.isInteger(value) ? value.toFixed(0) : value.toFixed(1);
}

function item(color: string, name: string): HTMLElement {
  const swatch = el('span', { class: 'swatch' });
  swatch.style.background = color;
  return el('li', {}, swatch, name);
}

/** What the colours of a mode mean: a bar with its unit, or the kinds of points. */
export function legendOf(mode: ColorMode, map: MapInfo, ranges: DataRanges,
                         cameras: ReadonlySet<number>): HTMLElement {
  const legend = el('div', { class: 'legend' });
  const ramp = rampOf(mode, ranges);
  if (ramp) {
    const bar = el('div', { class: 'bar' });
    bar.style.background = cssGradient(ramp.map);
    legend.append(bar, el('div', { class: 'ends' }, el('span', {}, number(ramp.low)),
      el('span', {}, number((ramp.low + ramp.high) / 2)),
      el('span', {}, `${number(ramp.high)} ${ramp.unit}`)));
  }
  const kinds = kindsOf(mode, map, cameras).map(({ name, color }) => item(cssColor(color), name));
  if (mode === 'error') kinds.push(item(cssColor(outsideGrey), 'not in this image'));
  if (mode === 'camera' || mode === 'views' || mode === 'error') {
    kinds.push(item(cssColor(neutralGrey), 'no camera saw it'));
  }
  if (kinds.length > 0) legend.append(el('ul', {}, ...kinds));
  return legend;
}
