import {
  BufferGeometry, DoubleSide, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments,
  Matrix4, Mesh, MeshBasicMaterial, Vector3,
} from 'three';

import { localPosition } from './picking';
import type { PointObject } from './point_object';
import { inverseOfRigid, matrixOfPose } from './pose';
import type { CameraInfo, MapInfo } from './protocol';

const shellColumns = 24;
const shellRows = 8;
const rayCount = 400;
const circleSteps = 64;

/** How far along the unit vector `d` from `c` the sphere of radius `r` round the LiDAR is. */
function distanceToShell(c: Vector3, d: Vector3, r: number): number {
  const b = c.dot(d);
  return -b + Math.sqrt(Math.max(0, b * b - c.lengthSq() + r * r));
}

/** A camera's pixel direction and centre in the LiDAR's frame. */
function rays(camera: CameraInfo): { center: Vector3; along: (u: number, v: number) => Vector3 } {
  const T_lidar_cam = inverseOfRigid(matrixOfPose(camera.T_cam_lidar));
  return {
    center: new Vector3().setFromMatrixPosition(T_lidar_cam),
    along: (u, v) => new Vector3((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1)
      .transformDirection(T_lidar_cam),
  };
}

/** The region that a frame textures: between two shells round the LiDAR, where a camera sees. */
function regionGeometries(camera: CameraInfo, near: number, far: number) {
  const { center, along } = rays(camera);
  const at = (column: number, row: number, r: number) => {
    const d = along(column / shellColumns * camera.width - 0.5,
      row / shellRows * camera.height - 0.5);
    return center.clone().addScaledVector(d, distanceToShell(center, d, r));
  };
  const lines: number[] = [];
  const faces: number[] = [];
  const line = (a: Vector3, b: Vector3) => lines.push(...a.toArray(), ...b.toArray());
  for (const r of [near, far]) {
    for (let row = 0; row <= shellRows; row += 4) {
      for (let i = 0; i < shellColumns; ++i) line(at(i, row, r), at(i + 1, row, r));
    }
    for (let column = 0; column <= shellColumns; column += 4) {
      for (let i = 0; i < shellRows; ++i) line(at(column, i, r), at(column, i + 1, r));
    }
    for (let column = 0; column < shellColumns; ++column) {
      for (let row = 0; row < shellRows; ++row) {
        const [a, b] = [at(column, row, r), at(column + 1, row, r)];
        const [c, d] = [at(column, row + 1, r), at(column + 1, row + 1, r)];
        for (const p of [a, b, c, c, b, d]) faces.push(...p.toArray());
      }
    }
  }
  for (const column of [0, shellColumns]) {
    for (const row of [0, shellRows]) line(at(column, row, near), at(column, row, far));
  }
  return { lines, faces };
}

/** Without a camera: where the shells meet the LiDAR's horizontal plane. */
function circles(near: number, far: number): number[] {
  const lines: number[] = [];
  for (const r of [near, far]) {
    for (let i = 0; i < circleSteps; ++i) {
      for (const j of [i, i + 1]) {
        const angle = j / circleSteps * 2 * Math.PI;
        lines.push(r * Math.cos(angle), r * Math.sin(angle), 0);
      }
    }
  }
  return lines;
}

function geometry(positions: number[]): BufferGeometry {
  return new BufferGeometry()
    .setAttribute('position', new Float32BufferAttribute(positions, 3));
}

/** The foveal region of a frame, and rays to points that it brought into the map. */
export class FovealOverlay {
  readonly group = new Group();
  private readonly region = new Group();
  private readonly rays = new LineSegments(new BufferGeometry(), new LineBasicMaterial({
    color: 0xffc65c, transparent: true, opacity: 0.4, depthWrite: false,
  }));

  constructor(private readonly map: MapInfo) {
    this.rays.frustumCulled = false;
    this.group.add(this.region, this.rays);
    if (!map.foveal) return;
    const { near, far } = map.foveal;
    const edges = new LineBasicMaterial({ color: 0x3fd0a0, transparent: true, opacity: 0.9 });
    const skin = new MeshBasicMaterial({
      color: 0x3fd0a0, transparent: true, opacity: 0.1, side: DoubleSide, depthWrite: false,
    });
    for (const camera of map.cameras) {
      const { lines, faces } = regionGeometries(camera, near, far);
      this.region.add(new LineSegments(geometry(lines), edges), new Mesh(geometry(faces), skin));
    }
    if (map.cameras.length === 0) {
      this.region.add(new LineSegments(geometry(circles(near, far)), edges));
    }
  }

  place(T_local_lidar: Matrix4, foveal: boolean): void {
    this.region.visible = foveal && this.map.foveal !== null;
    T_local_lidar.decompose(this.region.position, this.region.quaternion, this.region.scale);
  }

  clearRays(): void {
    this.rays.visible = false;
  }

  /** From where they were seen to a sample of the points of one frame. */
  showRays(frame: number, T_local_lidar: Matrix4, drawn: readonly PointObject[]): void {
    const found: { object: PointObject; index: number; camera: number }[] = [];
    for (const object of drawn) {
      if (!object.known) continue;
      const frames = object.geometry.getAttribute('_frame');
      const source = object.geometry.getAttribute('_source');
      for (let i = 0; i < object.pointCount; ++i) {
        if (frames.getX(i) === frame) found.push({ object, index: i, camera: source.getX(i) });
      }
    }
    const centers = new Map(this.map.cameras.map((camera) => [
      camera.index, rays(camera).center.applyMatrix4(T_local_lidar),
    ]));
    const lidar = new Vector3().setFromMatrixPosition(T_local_lidar);
    const positions: number[] = [];
    const step = Math.max(1, found.length / rayCount);
    for (let i = 0; i < found.length; i += step) {
      const { object, index, camera } = found[Math.floor(i)]!;
      positions.push(...(centers.get(camera) ?? lidar).toArray(),
        ...localPosition(object, index).toArray());
    }
    this.rays.geometry.dispose();
    this.rays.geometry = geometry(positions);
    this.rays.visible = positions.length > 0;
  }
}
