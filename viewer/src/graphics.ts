/** What draws in this browser. */
export interface Graphics {
  /** No graphics card: every pixel costs, so edges are not smoothed. */
  readonly software: boolean;
}

/** Null where there is no WebGL 2. */
export function graphicsOfBrowser(): Graphics | null {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return null;
  let name = String(gl.getParameter(gl.RENDERER));
  if (name === 'WebKit WebGL') {  // Chromium's and Safari's general answer
    const info = gl.getExtension('WEBGL_debug_renderer_info');
    if (info) name = String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL));
  }
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return { software: /swiftshader|llvmpipe|software/i.test(name) };
}
