import {
  DataTexture, DepthTexture, GLSL3, LinearFilter, Matrix4, NearestFilter, NoBlending, RGBAFormat,
  ShaderMaterial, Texture, Vector2, Vector3, Vector4,
} from 'three';

import { colorMapNames, colorTable } from './color_maps';
import {
  colorModes, kindTable, neutralGrey, outsideGrey, rampOf, type DataRanges,
} from './color_modes';
import type { Intrinsics } from './intrinsics';
import { pointFragmentShader, pointVertexShader } from './point_shader';
import { showsUncolored, type Settings } from './settings';

const tableWidth = 256;

/** Spacing alone leaves gaps where points of a surface are not in rows. */
const overlap = 1.7;

function table(data: Uint8Array<ArrayBuffer>, width: number, height: number): DataTexture {
  const texture = new DataTexture(data, width, height, RGBAFormat);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** What one object of points is, set before each of its draws. */
function objectUniforms() {
  return {
    spacing: { value: 0.02 },
    known: { value: true },
    linear: { value: true },
    objectId: { value: 0 },
  };
}

/** What all passes over points share. */
function passUniforms() {
  return {
    pixelsPerUnit: { value: 1 },
    splatSize: { value: overlap },
    smallest: { value: 1.5 },
    largest: { value: 64 },
    showUncolored: { value: false },
  };
}

function pictureUniforms() {
  return {
    mode: { value: 0 },
    ramp: { value: new Vector2(0, 1) },
    rampRow: { value: 0 },
    fovea: { value: new Vector2() },
    neutral: { value: new Vector3(...neutralGrey) },
    outside: { value: new Vector3(...outsideGrey) },
    ramps: { value: table(colorTable(tableWidth), tableWidth, colorMapNames.length) },
    kinds: { value: table(kindTable(), 16, 1) },
    image: { value: null as Texture | null },
    imageDepth: { value: null as DepthTexture | null },
    imageSize: { value: new Vector2(1, 1) },
    intrinsics: { value: new Vector4(1, 1, 0, 0) },
    T_cam_local: { value: new Matrix4() },
    imageRange: { value: new Vector2(0.3, 300) },
    imageReady: { value: false },
  };
}

type ObjectUniforms = ReturnType<typeof objectUniforms>;
type PassUniforms = ReturnType<typeof passUniforms>;

function material(uniforms: object, defines: Record<string, string>): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: pointVertexShader,
    fragmentShader: pointFragmentShader,
    uniforms: uniforms as ShaderMaterial['uniforms'],
    defines,
    blending: NoBlending,
  });
}

/** The materials of points: one for the picture, one for ids, one for depth. All objects share them
 * and say what they are by `describe` just before they are drawn. */
export class PointMaterials {
  readonly shared = passUniforms();
  readonly picture = pictureUniforms();
  readonly pictureMaterial: ShaderMaterial;
  readonly pickMaterial: ShaderMaterial;
  readonly depthMaterial: ShaderMaterial;
  private readonly depthPass = passUniforms();

  constructor() {
    this.pictureMaterial = material(
      { ...objectUniforms(), ...this.shared, ...this.picture }, { PICTURE: '' });
    this.pickMaterial = material(
      { ...objectUniforms(), ...this.shared }, { PICK: '', BULGED: '' });
    this.depthPass.showUncolored.value = true;
    this.depthPass.splatSize.value = 1.1;
    this.depthMaterial = material({ ...objectUniforms(), ...this.depthPass }, {});
    this.depthMaterial.colorWrite = false;
  }

  static describe(of: ShaderMaterial, what: { spacing: number; known: boolean; linear: boolean },
                  objectId: number): void {
    const uniforms = of.uniforms as unknown as ObjectUniforms;
    uniforms.spacing.value = what.spacing;
    uniforms.known.value = what.known;
    uniforms.linear.value = what.linear;
    uniforms.objectId.value = objectId;
    of.uniformsNeedUpdate = true;
  }

  setPixelsPerUnit(pixels: number, ratio: number): void {
    this.shared.pixelsPerUnit.value = pixels;
    this.shared.smallest.value = 1.5 * ratio;
    this.shared.largest.value = 64 * ratio;
  }

  depthUniforms(): PassUniforms {
    return this.depthPass;
  }

  setFovea(near: number, far: number): void {
    this.picture.fovea.value.set(near, far);
  }

  choose(settings: Settings): void {
    this.picture.mode.value = colorModes.indexOf(settings.mode);
    this.shared.showUncolored.value = showsUncolored(settings);
    this.shared.splatSize.value = overlap * settings.splatSize;
    const bulged = 'BULGED' in this.pictureMaterial.defines;
    if (bulged !== settings.paraboloids) {
      this.pictureMaterial.defines = { PICTURE: '', ...(settings.paraboloids && { BULGED: '' }) };
      this.pictureMaterial.needsUpdate = true;
    }
  }

  scale(settings: Settings, ranges: DataRanges): void {
    const ramp = rampOf(settings.mode, ranges);
    if (!ramp) return;
    this.picture.ramp.value.set(ramp.low, 1 / Math.max(ramp.high - ramp.low, 1e-6));
    this.picture.rampRow.value = colorMapNames.indexOf(ramp.map);
  }

  compareWith(image: Texture, depth: DepthTexture, camera: Intrinsics, T_cam_local: Matrix4): void {
    image.minFilter = image.magFilter = LinearFilter;
    this.picture.image.value = image;
    this.picture.imageDepth.value = depth;
    this.picture.imageSize.value.set(camera.width, camera.height);
    this.picture.intrinsics.value.set(camera.fx, camera.fy, camera.cx, camera.cy);
    this.picture.T_cam_local.value.copy(T_cam_local);
    this.picture.imageReady.value = true;
  }

  compareWithNothing(): void {
    this.picture.imageReady.value = false;
    this.picture.image.value = null;
    this.picture.imageDepth.value = null;
  }
}
