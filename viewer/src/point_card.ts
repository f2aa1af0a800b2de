import { el, iconButton } from './dom';
import { geodeticOfEnu } from './geodesy';
import { icon } from './icons';
import type { PickedPoint } from './picking';
import { factsOf } from './point_facts';
import type { MapInfo } from './protocol';
import type { Trajectory } from './trajectory';

export interface PointCardEvents {
  lookFrom(frame: number, camera: number | null): void;
  close(): void;
}

/** What the map knows of a point. */
export class PointCard {
  readonly element = el('aside', {
    class: 'point-card card', 'aria-label': 'The picked point', hidden: true,
  });

  constructor(private readonly map: MapInfo, private readonly trajectory: Trajectory,
              private readonly events: PointCardEvents) {}

  hide(): void {
    this.element.hidden = true;
  }

  show(point: PickedPoint): void {
    const facts = factsOf(point, this.map);
    const rows: [string, string][] = [];
    const { x, y, z } = point.position;
    rows.push(['Position (m)', `${x.toFixed(3)}, ${y.toFixed(3)}, ${z.toFixed(3)}`]);
    if (this.map.origin) {
      const { latitude, longitude, altitude } = geodeticOfEnu(this.map.origin, point.position);
      rows.push(['Latitude', `${latitude.toFixed(8)}°`],
        ['Longitude', `${longitude.toFixed(8)}°`], ['Altitude', `${altitude.toFixed(3)} m`]);
    }
    const { frame, camera } = facts;
    const row = frame === null ? undefined : this.trajectory.row(frame);
    const time = row === undefined ? null : this.trajectory.frame(row)!.time;
    if (frame !== null) rows.push(['Frame', String(frame)]);
    if (time !== null) rows.push(['Time', `${time.toFixed(2)} s`]);
    if (point.object.known) {
      rows.push(['Camera', facts.camera === null ? 'none' : String(facts.camera)]);
      if (facts.range !== null) rows.push(['Range', `${facts.range.toFixed(2)} m`]);
      if (facts.incidence !== null) rows.push(['Incidence', `${facts.incidence.toFixed(1)}°`]);
      rows.push(['Rule', (facts.rule ?? 'unknown') + (facts.interpolated ? ', interpolated' : '')]);
      if (facts.views !== null) rows.push(['Views', `${facts.views}`]);
      if (facts.spread !== null) rows.push(['Spread', `${facts.spread} grey values`]);
    }
    const swatch = el('span', { class: 'swatch' });
    swatch.style.background = `rgb(${facts.color.join(' ')})`;
    const color = el('dd', {}, swatch, facts.color.join(' '),
      facts.matched ? ' (exposure matched)' : '');
    this.element.replaceChildren(
      el('header', {}, el('h2', {}, 'Point'),
        iconButton(icon('close'), 'Close', () => this.events.close())),
      el('dl', {}, ...rows.flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, value)]),
        el('dt', {}, 'Colour'), color),
      row === undefined || frame === null ? '' :
        el('button', {
          type: 'button', class: 'plain', onclick: () => this.events.lookFrom(frame, camera),
        }, 'Look from there'));
    this.element.hidden = false;
  }
}
