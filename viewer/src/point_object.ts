import { Points, type BufferGeometry, type ShaderMaterial } from 'three';

import { PointMaterials } from './point_material';

/** Points that are drawn as splats, all of one spacing. */
export class PointObject extends Points<BufferGeometry, ShaderMaterial> {
  spacing: number;
  readonly known: boolean;
  readonly linear: boolean;

  constructor(geometry: BufferGeometry, material: ShaderMaterial, spacing: number,
              linear: boolean) {
    super(geometry, material);
    this.spacing = spacing;
    this.linear = linear;
    this.known = ['_frame', '_sight', '_source'].every((name) => geometry.hasAttribute(name));
    this.onBeforeRender = (_renderer, _scene, _camera, _geometry, used) => {
      PointMaterials.describe(used as ShaderMaterial, this, this.id);
    };
  }

  get pointCount(): number {
    const all = this.geometry.getAttribute('position').count;
    return Math.min(all, this.geometry.drawRange.count);
  }
}
