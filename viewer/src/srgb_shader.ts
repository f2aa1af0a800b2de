/** GLSL: the sRGB value of linear light (IEC 61966-2-1). */
export const srgbOfLight = /* glsl */`
vec3 srgbOfLight(vec3 light) {
  return mix(12.92 * light, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055,
             step(0.0031308, light));
}
`;
