// One vertex shader for all that is made of points: the picture, ids under the cursor, depth alone.
// Colours are worked out in sRGB values, as they stand in the images and on the screen.

import { srgbOfLight } from './srgb_shader';

export const pointVertexShader = /* glsl */`
in vec4 color;
in float _frame;
in vec2 _sight;
in vec4 _source;

uniform float spacing;         // m between points of this object
uniform bool known;            // whether the object has _frame, _sight and _source
uniform bool linear;           // whether its colours are linear light
uniform float pixelsPerUnit;   // of something 1 m wide, 1 m away
uniform float splatSize;
uniform float smallest;
uniform float largest;
uniform bool showUncolored;

out float radius;              // of the splat, in metres
out float pixels;

#ifdef PICTURE
uniform int mode;
uniform vec2 ramp;             // value at the scale's beginning, 1 / its length
uniform int rampRow;
uniform vec2 fovea;
uniform vec3 neutral;
uniform vec3 outside;
uniform sampler2D ramps;
uniform sampler2D kinds;
uniform sampler2D image;
uniform highp sampler2D imageDepth;
uniform vec2 imageSize;
uniform vec4 intrinsics;       // fx, fy, cx, cy
uniform mat4 T_cam_local;
uniform vec2 imageRange;       // near, far of the depth picture
uniform bool imageReady;
flat out vec3 splatColor;
#endif
#ifdef PICK
flat out uint pointId;
#endif

#ifdef PICTURE
${srgbOfLight}
vec3 photograph() {
  return linear ? srgbOfLight(color.rgb) : color.rgb;
}

vec3 onRamp(float value) {
  float x = clamp((value - ramp.x) * ramp.y, 0.0, 1.0);
  return texelFetch(ramps, ivec2(int(x * 255.0 + 0.5), rampRow), 0).rgb;
}

vec3 ofKind(int index) {
  return texelFetch(kinds, ivec2(index & 15, 0), 0).rgb;
}

// How far away what the image shows there is: the farthest of neighbouring pixels, for on ground
// seen from low a pixel is metres long.
float frontOf(vec2 at) {
  ivec2 size = textureSize(imageDepth, 0);
  ivec2 middle = ivec2(at * vec2(size));
  float d = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 pixel = clamp(middle + ivec2(x, y), ivec2(0), size - 1);
      float there = texelFetch(imageDepth, pixel, 0).r;
      if (there < 1.0) d = max(d, there);
    }
  }
  float z = 2.0 * d - 1.0;
  return 2.0 * imageRange.x * imageRange.y /
      (imageRange.y + imageRange.x - z * (imageRange.y - imageRange.x));
}

// How far the point's colour is from the image; grey where the image does not show the point.
vec3 imageError(vec3 own) {
  if (!imageReady) return outside;
  vec3 p = (T_cam_local * (modelMatrix * vec4(position, 1.0))).xyz;
  if (p.z < imageRange.x) return outside;
  vec2 at = (intrinsics.xy * p.xy / p.z + intrinsics.zw + 0.5) / imageSize;
  if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(1.0)))) return outside;
  float front = frontOf(vec2(at.x, 1.0 - at.y));
  // A splat of ground in front, seen from low, reaches over what lies some spacings behind it.
  if (p.z > 1.02 * front + 0.1 + 4.0 * spacing) return outside;
  vec3 seen = textureLod(image, at, 0.0).rgb;
  return onRamp(255.0 * dot(abs(own - seen), vec3(1.0 / 3.0)));
}

vec3 shown(vec4 source, bool colored) {
  vec3 own = colored ? photograph() : neutral;
  if (mode == 0) return own;
  if (mode == 1) return onRamp((modelMatrix * vec4(position, 1.0)).z);
  if (mode == 7) return colored ? imageError(own) : neutral;
  if (!known) return neutral;
  if (mode == 2) return _sight.x > 65534.5 ? neutral : onRamp(0.01 * _sight.x);
  if (mode == 3) return colored ? ofKind(int(source.x)) : neutral;
  if (mode == 4) return onRamp(_frame);
  if (mode == 5) return ofKind(int(source.y) & 15);
  if (mode == 6) return colored ? onRamp(source.z) : neutral;
  float range = 0.01 * _sight.x;
  if (_sight.x > 65534.5) return neutral;
  return ofKind(range < fovea.x ? 0 : range < fovea.y ? 1 : 2);
}
#endif

void main() {
  vec4 source = known ? _source : vec4(0.0, 0.0, 1.0, 0.0);
  bool colored = source.x < 254.5;
  if (!colored && !showUncolored) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = 0.0;
    return;
  }
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * p;
  float wanted = spacing * splatSize * pixelsPerUnit / max(-p.z, 1e-3);
  gl_PointSize = clamp(wanted, smallest, largest);
  pixels = gl_PointSize;
  radius = 0.5 * gl_PointSize * max(-p.z, 1e-3) / pixelsPerUnit;
#ifdef PICTURE
  splatColor = shown(source, colored);
#endif
#ifdef PICK
  pointId = uint(gl_VertexID);
#endif
}
`;

// A splat bulges towards the viewer, so that where two overlap each keeps its own half.
const splat = /* glsl */`
in float radius;
in float pixels;
uniform mat4 projectionMatrix;

float bulgedDepth(float r2) {
  float ndc = 2.0 * gl_FragCoord.z - 1.0;
  float z = projectionMatrix[3][2] / (ndc + projectionMatrix[2][2]);
  float nearer = max(z - radius * (1.0 - r2), 1e-3);
  return 0.5 + 0.5 * (projectionMatrix[3][2] / nearer - projectionMatrix[2][2]);
}
`;

export const pointFragmentShader = /* glsl */`
precision highp float;
precision highp int;
${splat}
#ifdef PICTURE
flat in vec3 splatColor;
out vec4 fragment;
#endif
#ifdef PICK
flat in uint pointId;
uniform uint objectId;
out uvec4 fragment;
#endif

void main() {
  vec2 offset = 2.0 * gl_PointCoord - 1.0;
  float r2 = dot(offset, offset);
  if (pixels > 2.5 && r2 > 1.0) discard;
#ifdef BULGED
  gl_FragDepth = bulgedDepth(min(r2, 1.0));
#endif
#ifdef PICTURE
  fragment = vec4(splatColor, 1.0);
#endif
#ifdef PICK
  fragment = uvec4(objectId, pointId, floatBitsToUint(gl_FragCoord.z), 1u);
#endif
}
`;
