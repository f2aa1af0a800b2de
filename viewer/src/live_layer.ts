import {
  BufferAttribute, BufferGeometry, Group, Sphere, Vector3, type TypedArray,
} from 'three';

import type { PointsMessage, TileSection } from './live_message';
import type { PointMaterials } from './point_material';
import { PointObject } from './point_object';
import { matrixOfPose } from './pose';
import type { Pose } from './protocol';

/** Live points are thinned to about this (m). */
const liveSpacing = 0.06;
const millimetre = 0.001;

interface Column {
  readonly name: string;
  readonly width: number;
  readonly normalized: boolean;
  readonly make: (length: number) => TypedArray;
}

const columns: readonly Column[] = [
  { name: 'position', width: 3, normalized: false, make: (n) => new Uint16Array(n) },
  { name: 'color', width: 4, normalized: true, make: (n) => new Uint8Array(n) },
  { name: '_source', width: 4, normalized: false, make: (n) => new Uint8Array(n) },
  { name: '_frame', width: 1, normalized: false, make: (n) => new Float32Array(n) },
  { name: '_sight', width: 2, normalized: false, make: (n) => new Uint16Array(n) },
];

/** Room for points, twice as much each time it is short. */
function geometryOf(capacity: number, before: BufferGeometry | null, kept: number): BufferGeometry {
  const geometry = new BufferGeometry();
  for (const { name, width, normalized, make } of columns) {
    const data = make(width * capacity);
    if (before) data.set(before.getAttribute(name).array.subarray(0, width * kept) as never);
    geometry.setAttribute(name, new BufferAttribute(data, width, normalized));
  }
  return geometry;
}

/** A tile of a submap, which grows. */
class LiveTile {
  readonly object: PointObject;
  private capacity: number;
  private count = 0;

  constructor(materials: PointMaterials, group: Group, section: TileSection,
              private readonly size: number) {
    this.capacity = Math.max(256, 2 * section.count);
    const geometry = geometryOf(this.capacity, null, 0);
    geometry.setDrawRange(0, 0);
    this.object = new PointObject(geometry, materials.pictureMaterial, liveSpacing, false);
    this.object.position.set(...section.tile).multiplyScalar(size);
    this.object.scale.setScalar(millimetre);
    this.bound(geometry);
    group.add(this.object);
  }

  get points(): number {
    return this.count;
  }

  take(section: TileSection): void {
    if (section.whole) this.count = 0;
    const total = this.count + section.count;
    if (total > this.capacity) {
      this.capacity = 2 * total;
      const grown = geometryOf(this.capacity, this.object.geometry, this.count);
      this.object.geometry.dispose();
      this.bound(grown);
      this.object.geometry = grown;
    }
    this.put('position', section.position);
    this.put('_frame', section.frame);
    this.put('_sight', section.sight);
    this.putColors(section);
    this.count = total;
    this.object.geometry.setDrawRange(0, total);
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.removeFromParent();
  }

  private bound(geometry: BufferGeometry): void {
    const half = this.size / 2 / millimetre;
    geometry.boundingSphere = new Sphere(new Vector3(half, half, half), half * Math.sqrt(3));
  }

  private put(name: string, data: TypedArray): void {
    const attribute = this.object.geometry.getAttribute(name) as BufferAttribute;
    const start = attribute.itemSize * this.count;
    attribute.array.set(data as never, start);
    attribute.addUpdateRange(start, data.length);
    attribute.needsUpdate = true;
  }

  /** The message has the camera beside the colour; a finished tile, and so the shader, has it
   * beside the rule. */
  private putColors({ color, source, count }: TileSection): void {
    const sources = new Uint8Array(4 * count);
    const colors = new Uint8Array(4 * count);
    for (let i = 0; i < 4 * count; i += 4) {
      colors[i] = color[i]!;
      colors[i + 1] = color[i + 1]!;
      colors[i + 2] = color[i + 2]!;
      colors[i + 3] = 255;
      sources[i] = color[i + 3]!;
      sources[i + 1] = source[i]!;
      sources[i + 2] = source[i + 1]!;
      sources[i + 3] = source[i + 2]!;
    }
    this.put('color', colors);
    this.put('_source', sources);
  }
}

/** The growing map: a group for each submap, in it a tile each. */
export class LiveLayer {
  readonly group = new Group();
  readonly cameras = new Set<number>();
  private readonly submaps = new Map<number, Group>();
  private readonly tiles = new Map<string, LiveTile>();

  constructor(private readonly materials: PointMaterials, private readonly tileSize: number) {}

  get points(): number {
    let points = 0;
    for (const tile of this.tiles.values()) points += tile.points;
    return points;
  }

  setSubmapPose(index: number, T_local_submap: Pose): void {
    const submap = this.submap(index);
    matrixOfPose(T_local_submap).decompose(submap.position, submap.quaternion, submap.scale);
    submap.updateMatrixWorld(true);
  }

  take(message: PointsMessage): void {
    for (const section of message.sections) {
      const key = [section.submap, ...section.tile].join();
      let tile = this.tiles.get(key);
      if (section.count === 0) {
        if (section.whole && tile) {
          tile.dispose();
          this.tiles.delete(key);
        }
        continue;
      }
      if (!tile) {
        tile = new LiveTile(this.materials, this.submap(section.submap), section, this.tileSize);
        this.tiles.set(key, tile);
      }
      tile.take(section);
      this.cameras.add(section.color[3]!);
    }
  }

  /** All points and submaps: another session begins. */
  clear(): void {
    for (const tile of this.tiles.values()) tile.dispose();
    this.tiles.clear();
    for (const submap of this.submaps.values()) submap.removeFromParent();
    this.submaps.clear();
    this.cameras.clear();
  }

  private submap(index: number): Group {
    let submap = this.submaps.get(index);
    if (!submap) {
      submap = new Group();
      this.submaps.set(index, submap);
      this.group.add(submap);
    }
    return submap;
  }
}
