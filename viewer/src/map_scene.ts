import {
  Color, ColorManagement, Group, LinearSRGBColorSpace, Object3D, PerspectiveCamera, Scene,
  WebGLRenderer,
} from 'three';

import { EyeDome } from './eye_dome';
import { PointMaterials } from './point_material';
import { PointObject } from './point_object';

ColorManagement.enabled = false;  // all colours here are sRGB values from end to end
Object3D.DEFAULT_UP.set(0, 0, 1);

export const near = 0.1;
export const far = 4000;

/** The picture: points or triangles, lit, and lines over them. */
export class MapScene {
  readonly renderer: WebGLRenderer;
  readonly camera = new PerspectiveCamera(60, 1, near, far);
  readonly points = new Scene();
  readonly lines = new Scene();
  readonly materials = new PointMaterials();
  readonly eyeDome = new EyeDome();
  /** What the last picture had. */
  pointsDrawn = 0;
  trianglesDrawn = 0;
  width = 1;
  height = 1;
  ratio = 1;

  constructor(readonly canvas: HTMLCanvasElement, antialias: boolean) {
    this.renderer = new WebGLRenderer({
      canvas, antialias, alpha: false, stencil: false, powerPreference: 'high-performance',
    });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = true;
    this.camera.matrixAutoUpdate = false;
  }

  setSize(width: number, height: number, ratio: number): void {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    this.ratio = ratio;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(this.width, this.height, false);
    this.eyeDome.setSize(this.canvas.width, this.canvas.height, ratio);
  }

  /** How far one can see in a map of this size (m). */
  setReach(size: number): void {
    this.camera.far = Math.max(far, 4 * size);
    this.camera.near = Math.max(near, this.camera.far / 100_000);
  }

  setBackground(above: Color, below: Color): void {
    this.eyeDome.setBackground(above, below);
  }

  add(layer: Group): void {
    this.points.add(layer);
  }

  remove(layer: Group): void {
    this.points.remove(layer);
  }

  /** Of something 1 m wide, 1 m in front of the camera. */
  get pixelsPerUnit(): number {
    return this.camera.projectionMatrix.elements[5]! * this.canvas.height / 2;
  }

  draw(): void {
    this.materials.setPixelsPerUnit(this.pixelsPerUnit, this.ratio);
    const { renderer, camera } = this;
    renderer.setRenderTarget(this.eyeDome.target);
    renderer.clear();
    renderer.render(this.points, camera);
    this.pointsDrawn = renderer.info.render.points;
    this.trianglesDrawn = renderer.info.render.triangles;
    renderer.setRenderTarget(null);
    renderer.clear();
    this.eyeDome.draw(renderer, camera);
    renderer.render(this.lines, camera);
  }

  drawnObjects(): PointObject[] {
    const found: PointObject[] = [];
    this.points.traverseVisible((object) => {
      if (object instanceof PointObject) found.push(object);
    });
    return found;
  }
}
