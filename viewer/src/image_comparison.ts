import {
  DepthTexture, FloatType, NearestFilter, NoColorSpace, PerspectiveCamera, Texture,
  WebGLRenderTarget,
} from 'three';

import { imageProjection } from './intrinsics';
import type { MapScene } from './map_scene';
import { place } from './navigation/view';
import { inverseOfRigid, matrixOfPose, viewOfCamera } from './pose';
import type { CameraInfo } from './protocol';
import { imagePath, whyNoImage } from './server';
import type { Trajectory } from './trajectory';

const depthWidth = 640;
const nearest = 0.3;
const farthest = 300;

/** The points' colours against a frame's image, for those that are not hidden from its camera. */
export class ImageComparison {
  readonly camera = new PerspectiveCamera();
  width = 1;
  height = 1;
  private readonly target: WebGLRenderTarget;
  private wanted = '';
  private texture: Texture | null = null;

  constructor(private readonly scene: MapScene, private readonly changed: () => void,
              private readonly failed: (why: string) => void) {
    const depthTexture = new DepthTexture(1, 1, FloatType);
    depthTexture.minFilter = depthTexture.magFilter = NearestFilter;
    this.target = new WebGLRenderTarget(1, 1, { depthTexture });
    this.camera.matrixAutoUpdate = false;
    this.camera.near = nearest;
    this.camera.far = farthest;
    scene.materials.picture.imageRange.value.set(nearest, farthest);
  }

  get active(): boolean {
    return this.wanted !== '';
  }

  stop(): void {
    this.wanted = '';
    this.texture?.dispose();
    this.texture = null;
    this.scene.materials.compareWithNothing();
  }

  choose(trajectory: Trajectory, row: number, camera: CameraInfo): void {
    const frame = trajectory.frame(row);
    const pose = trajectory.pose(row);
    if (!frame || !pose) return;
    place(this.camera, viewOfCamera(pose, camera.T_cam_lidar));
    this.camera.projectionMatrix.copy(imageProjection(camera, nearest, farthest));
    this.camera.projectionMatrixInverse.copy(this.camera.projectionMatrix).invert();
    this.width = Math.min(depthWidth, camera.width);
    this.height = Math.round(this.width * camera.height / camera.width);
    this.target.setSize(this.width, this.height);
    const path = imagePath(frame.index, camera.index);
    if (path === this.wanted) return;
    this.stop();
    this.wanted = path;
    const T_cam_local = matrixOfPose(camera.T_cam_lidar).multiply(inverseOfRigid(pose));
    const image = new Image();
    image.onload = () => {
      if (this.wanted !== path) return;
      this.texture = new Texture(image);
      this.texture.flipY = false;
      this.texture.generateMipmaps = false;
      this.texture.colorSpace = NoColorSpace;
      this.texture.needsUpdate = true;
      this.scene.materials.compareWith(
        this.texture, this.target.depthTexture!, camera, T_cam_local);
      this.changed();
    };
    image.onerror = () => {
      void whyNoImage(path).then((why) => {
        if (this.wanted === path) this.failed(why);
      });
    };
    image.src = path;
  }

  /** What the camera sees of the points that are drawn: whatever lies behind is not compared. */
  drawDepth(): void {
    if (!this.texture) return;
    const { renderer, points, materials } = this.scene;
    const uniforms = materials.depthUniforms();
    uniforms.pixelsPerUnit.value = this.camera.projectionMatrix.elements[5]! * this.height / 2;
    points.overrideMaterial = materials.depthMaterial;
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(points, this.camera);
    renderer.setRenderTarget(null);
    points.overrideMaterial = null;
  }
}
