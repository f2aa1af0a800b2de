import { iconButton } from './dom';
import { icon } from './icons';

/** Shows where north is; a click turns the view there. */
export class Compass {
  readonly element: HTMLButtonElement;

  constructor(turnNorth: () => void) {
    this.element = iconButton(icon('north'), 'North: click to look there', turnNorth);
    this.element.classList.add('compass', 'card');
  }

  /** `yaw`: of the view, radians from east, counter-clockwise. */
  show(yaw: number): void {
    const fromNorth = 90 - yaw * 180 / Math.PI;
    this.element.style.setProperty('--turn', `${(-fromNorth).toFixed(1)}deg`);
  }
}
