import { Vector3, type Camera } from 'three';

import { el } from './dom';
import type { MapScene } from './map_scene';
import { Measure } from './measure';
import { Picking, type PickedPoint } from './picking';
import { PointCard, type PointCardEvents } from './point_card';
import { factsOf } from './point_facts';
import type { MapInfo } from './protocol';
import { placeOnScreen } from './screen_place';
import type { PickedState } from './test_hook';
import type { Trajectory } from './trajectory';

/** What a click on the map does: tells of a point, or measures between points. */
export class PointTools {
  readonly measure = new Measure();
  readonly card: PointCard;
  readonly labels: HTMLElement;
  private readonly picking: Picking;
  private readonly ring = el('span', { class: 'ring', hidden: true });
  private picked: PickedPoint | null = null;
  private active = false;

  /** `surfaceAt`: the place in space at a pixel of the window. */
  constructor(scene: MapScene, private readonly map: MapInfo, trajectory: Trajectory,
              lookFrom: PointCardEvents['lookFrom'],
              private readonly surfaceAt: (x: number, y: number) => Vector3 | null) {
    this.picking = new Picking(scene);
    this.card = new PointCard(map, trajectory, { lookFrom, close: () => this.drop() });
    this.labels = el('div', { class: 'labels' }, this.measure.labels, this.ring);
    scene.lines.add(this.measure.line);
  }

  get measuring(): boolean {
    return this.active;
  }

  get pickedState(): PickedState | null {
    return this.picked && this.stateOf(this.picked);
  }

  /** The point at a place of the window. */
  at(x: number, y: number): PickedState | null {
    const point = this.map.mesh ? null : this.picking.at(x, y);
    return point && this.stateOf(point);
  }

  click(x: number, y: number): void {
    const point = this.map.mesh ? null : this.picking.at(x, y);
    if (this.active) {
      const place = this.map.mesh ? this.surfaceAt(x, y) : point?.position;
      if (place) this.measure.add(place);
    } else if (point) {
      this.picked = point;
      this.card.show(point);
    } else {
      this.drop();
    }
  }

  setMeasuring(measuring: boolean): void {
    this.active = measuring;
    if (!measuring) return;
    this.drop();
    this.measure.set([]);
  }

  /** The picked point is no longer. */
  drop(): void {
    this.picked = null;
    this.card.hide();
    this.ring.hidden = true;
  }

  setLine(corners: readonly (readonly [number, number, number])[]): void {
    this.measure.set(corners.map((corner) => new Vector3(...corner)));
  }

  /** Puts marks and labels where their places are in the picture. */
  place(camera: Camera, width: number, height: number): void {
    this.measure.place(camera, width, height);
    if (this.picked) placeOnScreen(this.ring, this.picked.position, camera, width, height);
  }

  private stateOf(point: PickedPoint): PickedState {
    const { frame, camera, color } = factsOf(point, this.map);
    return { position: point.position.toArray(), frame, camera, color };
  }
}
