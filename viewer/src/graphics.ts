/** What draws in this browser. */
export interface Graphics {
  /** No graphics card: every pixel costs, so edges are not smoothed. */
  readonly software: boolean;
}

/** Null where there is no WebGL 2. */
export function graphicsOfBrowser(): Graphics | null {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return null;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return { software: /swiftshader|llvmpipe|software/i.test(name) };
}
