import type { Camera, Vector3 } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

import { el } from './dom';
import { placeOnScreen } from './screen_place';

/** To millimetres nearby, to centimetres further. */
function metres(length: number): string {
  return `${length.toFixed(length < 100 ? 3 : 2)} m`;
}

/** Distances between points that the user picks: a line with its lengths. */
export class Measure {
  readonly line: LineSegments2;
  readonly labels = el('div', { class: 'measure-labels' });
  private readonly material = new LineMaterial({
    color: 0xffd24a, linewidth: 2.5, depthTest: false, transparent: true,
  });
  private points: Vector3[] = [];
  private tags: { element: HTMLElement; at: Vector3 }[] = [];

  constructor() {
    this.line = new LineSegments2(new LineSegmentsGeometry(), this.material);
    this.line.frustumCulled = false;
    this.line.visible = false;
    this.line.renderOrder = 10;
  }

  get corners(): readonly Vector3[] {
    return this.points;
  }

  /** The length of each piece. */
  get lengths(): number[] {
    return this.points.slice(1).map((point, i) => point.distanceTo(this.points[i]!));
  }

  set(points: readonly Vector3[]): void {
    this.points = [...points];
    this.rebuild();
  }

  add(point: Vector3): void {
    this.set([...this.points, point]);
  }

  undo(): void {
    this.set(this.points.slice(0, -1));
  }

  setResolution(width: number, height: number): void {
    this.material.resolution.set(width, height);
  }

  /** Puts the labels where their places are in the picture. */
  place(camera: Camera, width: number, height: number): void {
    for (const { element, at } of this.tags) placeOnScreen(element, at, camera, width, height);
  }

  private rebuild(): void {
    const { points, lengths } = this;
    const positions = lengths.flatMap((_, i) =>
      [...points[i]!.toArray(), ...points[i + 1]!.toArray()]);
    this.line.geometry.dispose();
    this.line.geometry = new LineSegmentsGeometry();
    this.line.visible = positions.length > 0;
    if (this.line.visible) this.line.geometry.setPositions(positions);
    this.tags = points.map((at) => ({ element: el('span', { class: 'corner' }), at }));
    lengths.forEach((length, i) => {
      const at = points[i]!.clone().lerp(points[i + 1]!, 0.5);
      this.tags.push({ element: el('span', { class: 'length' }, metres(length)), at });
    });
    if (lengths.length > 1) {
      const total = lengths.reduce((sum, length) => sum + length, 0);
      this.tags.push({
        element: el('span', { class: 'length total' }, `Σ ${metres(total)}`), at: points.at(-1)!,
      });
    }
    this.labels.replaceChildren(...this.tags.map(({ element }) => element));
  }
}
