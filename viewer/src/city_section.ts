import { el, short } from './dom';
import type { CityInfo, MapInfo } from './protocol';

/** "1.2 km" */
function kilometres(metres: number): string {
  return metres < 1000 ? `${Math.round(metres)} m` : `${(metres / 1000).toFixed(1)} km`;
}

/** "60.20 M points, 15 tiles, 256 × 320 m, revision 1" */
export function figuresOfCity(map: MapInfo, city: CityInfo): string {
  const [east, north] = city.extent.map((metres) => String(Math.round(metres)));
  return `${short(map.points)} points, ${city.tiles} tiles, ${east} × ${north} m, ` +
    `revision ${city.revision}`;
}

/** What a city has: its place, and a button for each drive. */
export class CitySection {
  readonly element: HTMLElement;
  private readonly drives: readonly HTMLButtonElement[];

  /** `look`: shows where the drive with this number begins. */
  constructor(map: MapInfo, city: CityInfo, look: (drive: number) => void) {
    const rows: [string, string][] = [
      ['Revision', String(city.revision)], ['Session', city.session],
    ];
    if (map.origin) {
      rows.push(['Origin', `${map.origin.latitude.toFixed(6)}°, ` +
        `${map.origin.longitude.toFixed(6)}°, ${map.origin.altitude.toFixed(1)} m`]);
    }
    const length = city.drives.reduce((sum, drive) => sum + drive.length, 0);
    this.drives = city.drives.map((drive, number) => el('button', {
      type: 'button', disabled: true, title: 'Look at the begin of the drive',
      onclick: () => look(number),
    }, el('span', {}, drive.name), el('span', {}, kilometres(drive.length))));
    this.element = el('section', { class: 'city' }, el('h2', {}, 'City'),
      el('dl', {}, ...rows.flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, value)])),
      el('details', {},
        el('summary', {}, `${city.drives.length} drives, ${kilometres(length)}`),
        el('ul', {}, ...this.drives.map((button) => el('li', {}, button)))));
  }

  /** Drives without a path in the tiles cannot be looked at. */
  setPaths(drives: ReadonlySet<number>): void {
    this.drives.forEach((button, number) => { button.disabled = !drives.has(number); });
  }
}
