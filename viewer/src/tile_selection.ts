// Which tiles are worth their points: the error that a budget of points can afford.

import { Box3, Frustum, Matrix4, Vector3, type Camera } from 'three';

export interface TileNode {
  readonly box: Box3;
  readonly geometricError: number;
  readonly children: readonly TileNode[];
  /** Points of its own; null as long as nobody has counted them. */
  points: number | null;
}

/** A camera as tiles see it: where it is, what is in view, pixels of 1 m at 1 m. */
export interface Viewpoint {
  readonly eye: Vector3;
  readonly frustum: Frustum;
  readonly pixelsPerUnit: number;
}

export function viewpointOf(camera: Camera, height: number): Viewpoint {
  const matrix = new Matrix4()
    .multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  return {
    eye: new Vector3().setFromMatrixPosition(camera.matrixWorld),
    frustum: new Frustum().setFromProjectionMatrix(matrix),
    pixelsPerUnit: camera.projectionMatrix.elements[5]! * height / 2,
  };
}

/** Inside a tile the error would be infinite, and no target could choose between such tiles (m). */
export const nearestDistance = 2;

/** Of a first tile that nobody has counted. */
const usualPoints = 20000;
/** Half the spacing on surfaces: all children together have up to four times a tile's points. */
const childrenShare = 4;

interface Candidate {
  readonly node: TileNode;
  readonly error: number;
  /** What it counts as. */
  readonly points: number;
}

/** A binary heap, the largest error first. */
class Heap {
  private readonly items: Candidate[] = [];

  get size(): number {
    return this.items.length;
  }

  push(item: Candidate): void {
    const items = this.items;
    let i = items.push(item) - 1;
    while (i > 0) {
      const parent = (i - 1) >> 1;
      if (items[parent]!.error >= item.error) break;
      items[i] = items[parent]!;
      i = parent;
    }
    items[i] = item;
  }

  pop(): Candidate {
    const items = this.items;
    const top = items[0]!;
    const last = items.pop()!;
    if (items.length > 0) {
      let i = 0;
      for (;;) {
        let child = 2 * i + 1;
        if (child >= items.length) break;
        if (child + 1 < items.length && items[child + 1]!.error > items[child]!.error) ++child;
        if (items[child]!.error <= last.error) break;
        items[i] = items[child]!;
        i = child;
      }
      items[i] = last;
    }
    return top;
  }
}

/** Tiles are counted when they come; until then they are taken to be like those above them. A tile
 * without points of its own counts as its children, which are always drawn in its place. */
function pointsOf(node: TileNode, guess: number, isInView: (node: TileNode) => boolean): number {
  const { points, children } = node;
  if (points === null) return guess;
  if (points > 0 || children.length === 0) return points;
  return children.filter(isInView).reduce(
    (sum, child) => sum + pointsOf(child, guess / children.length, isInView), 0);
}

export interface Selection {
  /** Tiles whose error on the screen is larger are refined (pixels). */
  readonly errorTarget: number;
  readonly points: number;
  /** Whether the budget, and not the error, ended the refinement. */
  readonly limited: boolean;
}

/**
 * The smallest error on the screen, not below `finest` pixels, at which the tiles in view have no
 * more than `budget` points. Refines the largest error first, as those of children are smaller.
 */
export function selectError(root: TileNode, view: Viewpoint, budget: number,
                            finest: number): Selection {
  const errorOf = (node: TileNode) => node.geometricError * view.pixelsPerUnit /
    Math.max(node.box.distanceToPoint(view.eye), nearestDistance);
  const isInView = (node: TileNode) => view.frustum.intersectsBox(node.box);
  const heap = new Heap();
  const ofRoot = isInView(root) ? pointsOf(root, usualPoints, isInView) : 0;
  let drawn = ofRoot;
  if (isInView(root)) heap.push({ node: root, error: errorOf(root), points: ofRoot });
  while (heap.size > 0) {
    const { node, error, points } = heap.pop();
    if (error <= finest) break;
    const { children } = node;
    if (children.length === 0) continue;
    const guess = points * (node.points === 0 ? 1 : childrenShare) / children.length;
    const refined = children.filter(isInView).map((child) => (
      { node: child, error: errorOf(child), points: pointsOf(child, guess, isInView) }));
    const ofAll = refined.reduce((sum, child) => sum + child.points, drawn - points);
    if (ofAll > budget && node.points !== 0) {
      return { errorTarget: Math.max(error, finest), points: drawn, limited: true };
    }
    drawn = ofAll;
    for (const child of refined) heap.push(child);
  }
  return { errorTarget: finest, points: drawn, limited: false };
}
