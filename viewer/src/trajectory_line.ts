import {
  BoxGeometry, BufferGeometry, Color, ConeGeometry, EdgesGeometry, Float32BufferAttribute, Group,
  LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, Points, PointsMaterial,
  type Vector3,
} from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

import type { Trajectory } from './trajectory';

const mappedColor = new Color(0x4a93ee);
const heldOutColor = new Color(0xeda100);
const skippedColor = new Color(0x9aa3b2);
const vehicleColor = 0xff7a3d;
/** Of a car that carries its LiDAR on the roof (m). */
const vehicle = { length: 4.4, width: 1.8, height: 1.5, lidarHeight: 1.73 };

function vehicleMarker(): Group {
  const box = new BoxGeometry(vehicle.length, vehicle.width, vehicle.height);
  const edges = new LineSegments(
    new EdgesGeometry(box), new LineBasicMaterial({ color: vehicleColor }));
  edges.position.z = vehicle.height / 2 - vehicle.lidarHeight;
  // An arrow that lies flat over the roof.
  const nose = new Mesh(new ConeGeometry(0.6, 1.6, 4).rotateZ(-Math.PI / 2).scale(1, 1, 0.1),
    new MeshBasicMaterial({ color: vehicleColor }));
  const marker = new Group();
  marker.add(edges, nose);
  return marker;
}

/** The way of the vehicle, its frames and where it is now. */
export class TrajectoryLine {
  readonly group = new Group();
  private readonly material = new LineMaterial({ linewidth: 2.5, vertexColors: true });
  private readonly line = new LineSegments2(new LineSegmentsGeometry(), this.material);
  private readonly dots = new Points(new BufferGeometry(),
    new PointsMaterial({ size: 6, sizeAttenuation: false, vertexColors: true }));
  private readonly marker = vehicleMarker();

  constructor(private readonly trajectory: Trajectory) {
    this.line.frustumCulled = this.dots.frustumCulled = false;
    this.group.add(this.line, this.dots, this.marker);
  }

  setResolution(width: number, height: number): void {
    this.material.resolution.set(width, height);
  }

  /** The frames have changed. */
  update(): void {
    const positions: number[] = [];
    const colors: number[] = [];
    const places: number[] = [];
    const placeColors: number[] = [];
    this.trajectory.all().forEach((frame, row) => {
      const at = this.trajectory.position(row);
      const color = { mapped: mappedColor, 'held-out': heldOutColor, skipped: skippedColor }[
        frame.status];
      places.push(...at.toArray());
      placeColors.push(...color.toArray());
      const before = this.trajectory.frame(row - 1);
      if (!before || before.drive !== frame.drive) return;
      positions.push(...this.trajectory.position(row - 1).toArray(), ...at.toArray());
      colors.push(...color.toArray(), ...color.toArray());
    });
    this.line.geometry.dispose();
    this.line.geometry = new LineSegmentsGeometry();
    if (positions.length > 0) {
      this.line.geometry.setPositions(positions);
      this.line.geometry.setColors(colors);
    }
    this.dots.geometry.dispose();
    this.dots.geometry = new BufferGeometry();
    this.dots.geometry.setAttribute('position', new Float32BufferAttribute(places, 3));
    this.dots.geometry.setAttribute('color', new Float32BufferAttribute(placeColors, 3));
  }

  show(row: number): void {
    this.trajectory.poseAt(row)
      .decompose(this.marker.position, this.marker.quaternion, this.marker.scale);
  }

  /** From inside the vehicle its box would be all that one sees. `along`: one is on the line. */
  seenFrom(eye: Vector3, along: boolean): void {
    this.marker.visible = this.trajectory.length > 0 && !along &&
      eye.distanceTo(this.marker.position) > 0.8 * vehicle.length;
    this.dots.visible = this.line.visible = this.trajectory.length > 1 && !along;
  }
}
