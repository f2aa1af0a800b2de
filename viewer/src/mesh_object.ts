import { GLSL3, Mesh, NoBlending, ShaderMaterial, type BufferGeometry } from 'three';

import { srgbOfLight } from './srgb_shader';

const vertexShader = /* glsl */`
in vec4 color;
out vec3 light;
void main() {
  light = color.rgb;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

const fragmentShader = /* glsl */`
precision highp float;
in vec3 light;
out vec4 fragment;
${srgbOfLight}
void main() {
  fragment = vec4(srgbOfLight(light), 1.0);
}
`;

/** Triangles are drawn in their vertices' colours: the light that the cameras saw is in them. */
export function meshMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3, vertexShader, fragmentShader, blending: NoBlending,
  });
}

/** The triangles of a tile. */
export class MeshObject extends Mesh<BufferGeometry, ShaderMaterial> {
  get vertexCount(): number {
    return this.geometry.getAttribute('position').count;
  }
}
