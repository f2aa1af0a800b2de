import { el } from './dom';

const keys: readonly (readonly [readonly string[], string])[] = [
  [['1', '2', '3'], 'Orbit, fly, walk along the drive'],
  [['Drag'], 'Orbit round the point under the cursor; look around when flying or walking'],
  [['Right drag', 'Shift drag'], 'Move sideways'],
  [['Wheel'], 'Towards the point under the cursor; along the drive when walking'],
  [['W', 'A', 'S', 'D', 'arrows'], 'Fly; forward and back along the drive when walking'],
  [['E', 'Q'], 'Up and down'],
  [['Shift'], 'Four times as fast'],
  [['Double click'], 'Go there'],
  [['Space'], 'Play or pause the drive'],
  [[',', '.'], 'One frame back, one on'],
  [['I'], 'Look from the frame with its camera, beside the photograph'],
  [['C'], 'Follow the vehicle'],
  [['M'], 'Measure; Backspace takes the last point back'],
  [['[', ']'], 'Previous and next colours'],
  [['U'], 'Points that no camera saw'],
  [['L'], 'Eye-dome lighting'],
  [['R'], 'Back behind the vehicle'],
  [['P'], 'Save the picture'],
  [['H'], 'Settings'],
  [['T'], 'Dark or light'],
  [['?'], 'This help'],
  [['Esc'], 'Close what is open'],
];

/** All keys and gestures, over the map. */
export class Help {
  readonly element: HTMLDialogElement;

  constructor(generator: string) {
    const list = el('dl', {}, ...keys.flatMap(([names, text]) => [
      el('dt', {}, ...names.map((name) => el('kbd', {}, name))),
      el('dd', {}, text),
    ]));
    this.element = el('dialog', { class: 'help card', 'aria-label': 'Keys and gestures' },
      el('h2', {}, 'Keys and gestures'), list,
      el('p', { class: 'hint' },
        'Touch: one finger orbits, two move and zoom, a tap picks a point.'),
      el('p', { class: 'hint' }, `Map by ${generator}.`),
      el('p', { class: 'close-row' }, el('button', {
        type: 'button', class: 'primary', autofocus: true, onclick: () => this.element.close(),
      }, 'Close')));
    this.element.addEventListener('click', (event) => {
      if (event.target === this.element) this.element.close();
    });
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.element.showModal();
  }
}
