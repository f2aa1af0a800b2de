import {
  NearestFilter, RGBAIntegerFormat, UnsignedIntType, WebGLRenderTarget, type WebGLRenderer,
} from 'three';

/** A small square picture of four unsigned integers a pixel, to be read back. */
export class IntegerTarget {
  readonly target: WebGLRenderTarget;
  private readonly pixels: Uint32Array<ArrayBuffer>;

  constructor(readonly size: number, depthBuffer: boolean) {
    this.target = new WebGLRenderTarget(size, size, {
      format: RGBAIntegerFormat, type: UnsignedIntType, internalFormat: 'RGBA32UI',
      minFilter: NearestFilter, magFilter: NearestFilter, depthBuffer,
    });
    this.pixels = new Uint32Array(4 * size * size);
  }

  /** Row by row from below. */
  read(renderer: WebGLRenderer): Uint32Array<ArrayBuffer> {
    renderer.readRenderTargetPixels(this.target, 0, 0, this.size, this.size, this.pixels);
    return this.pixels;
  }

  /** Pixels from the middle one outwards: column, row, and where its four numbers begin. */
  fromMiddle(): { x: number; y: number; at: number }[] {
    const middle = this.size >> 1;
    const all = [];
    for (let y = 0; y < this.size; ++y) {
      for (let x = 0; x < this.size; ++x) all.push({ x, y, at: 4 * (y * this.size + x) });
    }
    const distance = (p: { x: number; y: number }) => (p.x - middle) ** 2 + (p.y - middle) ** 2;
    return all.sort((a, b) => distance(a) - distance(b));
  }
}

const bits = new DataView(new ArrayBuffer(4));

export function floatOfBits(value: number): number {
  bits.setUint32(0, value);
  return bits.getFloat32(0);
}
