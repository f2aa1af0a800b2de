import {
  GLSL3, Mesh, NoBlending, OrthographicCamera, PlaneGeometry, ShaderMaterial, Vector2, Vector3,
  type PerspectiveCamera, type Texture, type WebGLRenderer,
} from 'three';

import { floatOfBits, IntegerTarget } from './integer_target';

const fragmentShader = /* glsl */`
precision highp float;
precision highp sampler2D;
uniform sampler2D depth;
uniform vec2 corner;
out highp uvec4 fragment;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy + corner);
  ivec2 size = textureSize(depth, 0);
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
  float d = inside ? texelFetch(depth, at, 0).r : 1.0;
  fragment = uvec4(floatBitsToUint(d), 0u, 0u, 0u);
}
`;

/** What lies under the cursor, from the depth of the last picture. */
export class DepthProbe {
  private readonly target = new IntegerTarget(17, false);
  private readonly order = this.target.fromMiddle();
  private readonly flat = new OrthographicCamera();
  private readonly material: ShaderMaterial;
  private readonly quad: Mesh;

  constructor(depth: Texture) {
    this.material = new ShaderMaterial({
      glslVersion: GLSL3, fragmentShader, blending: NoBlending, depthTest: false,
      vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
      uniforms: { depth: { value: depth }, corner: { value: new Vector2() } },
    });
    this.quad = new Mesh(new PlaneGeometry(2, 2), this.material);
    this.quad.frustumCulled = false;
  }

  /** The place in space at a pixel of the window (CSS pixels), or at the nearest that has one. */
  at(renderer: WebGLRenderer, camera: PerspectiveCamera, x: number, y: number): Vector3 | null {
    const ratio = renderer.getPixelRatio();
    const size = renderer.getDrawingBufferSize(new Vector2());
    const px = Math.floor(x * ratio);
    const py = Math.floor(size.y - y * ratio);
    const half = this.target.size >> 1;
    (this.material.uniforms.corner!.value as Vector2).set(px - half, py - half);
    renderer.setRenderTarget(this.target.target);
    renderer.render(this.quad, this.flat);
    const pixels = this.target.read(renderer);
    renderer.setRenderTarget(null);
    for (const pixel of this.order) {
      const depth = floatOfBits(pixels[pixel.at]!);
      if (depth >= 1) continue;
      const at = new Vector3(
        2 * (px - half + pixel.x + 0.5) / size.x - 1,
        2 * (py - half + pixel.y + 0.5) / size.y - 1, 2 * depth - 1);
      return at.applyMatrix4(camera.projectionMatrixInverse).applyMatrix4(camera.matrixWorld);
    }
    return null;
  }
}
