import {
  Color, DepthTexture, FloatType, GLSL3, Mesh, NearestFilter, OrthographicCamera, PlaneGeometry,
  RGBAFormat, ShaderMaterial, UnsignedByteType, Vector2, WebGLRenderTarget, type PerspectiveCamera,
  type WebGLRenderer,
} from 'three';

// Eye-dome lighting after C. Boucheny: what lies behind its neighbours on the screen is darker.
// Neighbours are taken in pairs across the pixel, so that a plane stays evenly bright however
// slanted, and steps as small as those between splats of one surface are none.
const fragmentShader = /* glsl */`
precision highp float;
precision highp sampler2D;
uniform sampler2D picture;
uniform sampler2D depth;
uniform vec2 texel;
uniform vec2 range;       // near, far
uniform float strength;   // 0: off
uniform float radius;     // pixels
uniform vec3 above;
uniform vec3 below;
in vec2 at;
out vec4 fragment;

const float tolerance = 0.004;

float logDistance(float d) {
  float z = 2.0 * d - 1.0;
  return log2(2.0 * range.x * range.y / (range.y + range.x - z * (range.y - range.x)));
}

float distanceAt(vec2 where, float own) {
  float d = texture(depth, where).r;
  return d < 1.0 ? logDistance(d) : own;
}

void main() {
  float d = texture(depth, at).r;
  gl_FragDepth = d;
  if (d >= 1.0) {
    fragment = vec4(mix(below, above, smoothstep(0.0, 1.0, at.y)), 1.0);
    return;
  }
  vec3 color = texture(picture, at).rgb;
  if (strength > 0.0) {
    float own = logDistance(d);
    float behind = 0.0;
    for (int i = 0; i < 4; ++i) {
      float angle = 0.7853981634 * float(i);
      vec2 step = radius * texel * vec2(cos(angle), sin(angle));
      behind += max(0.0, own - 0.5 * (distanceAt(at + step, own) + distanceAt(at - step, own)) -
                    tolerance);
    }
    color *= exp(-min(behind * 25.0, 2.0) * strength);
  }
  fragment = vec4(color, 1.0);
}
`;

const vertexShader = /* glsl */`
out vec2 at;
void main() {
  at = uv;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}
`;

/** The picture of the points with its depth, and the pass that lights it and puts it on screen. */
export class EyeDome {
  readonly target: WebGLRenderTarget;
  private readonly material: ShaderMaterial;
  private readonly quad: Mesh;
  private readonly flat = new OrthographicCamera();

  constructor() {
    const depthTexture = new DepthTexture(1, 1, FloatType);
    depthTexture.minFilter = depthTexture.magFilter = NearestFilter;
    this.target = new WebGLRenderTarget(1, 1, {
      depthTexture, format: RGBAFormat, type: UnsignedByteType,
      minFilter: NearestFilter, magFilter: NearestFilter,
    });
    this.material = new ShaderMaterial({
      glslVersion: GLSL3, vertexShader, fragmentShader, depthWrite: true,
      uniforms: {
        picture: { value: this.target.texture },
        depth: { value: depthTexture },
        texel: { value: new Vector2() },
        range: { value: new Vector2() },
        strength: { value: 0 },
        radius: { value: 1 },
        above: { value: new Color() },
        below: { value: new Color() },
      },
    });
    this.quad = new Mesh(new PlaneGeometry(2, 2), this.material);
    this.quad.frustumCulled = false;
  }

  setSize(width: number, height: number, ratio: number): void {
    this.target.setSize(width, height);
    this.uniform<Vector2>('texel').value.set(1 / width, 1 / height);
    this.uniform<number>('radius').value = 2.0 * ratio;
  }

  /** 0 to 1; 0 is off. */
  setStrength(strength: number): void {
    this.uniform<number>('strength').value = strength;
  }

  setBackground(above: Color, below: Color): void {
    this.uniform<Color>('above').value.copy(above);
    this.uniform<Color>('below').value.copy(below);
  }

  /** Puts picture and depth on the screen, so that lines can be drawn among the points. */
  draw(renderer: WebGLRenderer, camera: PerspectiveCamera): void {
    this.uniform<Vector2>('range').value.set(camera.near, camera.far);
    renderer.render(this.quad, this.flat);
  }

  private uniform<T>(name: string): { value: T } {
    return this.material.uniforms[name] as { value: T };
  }
}
