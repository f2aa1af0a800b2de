/**
 * The spacing of points on surfaces, from their number and the area they cover: cells of a coarse
 * grid that have points are taken as pieces of surface. `positions` are in units of `scale` metres.
 */
export function estimatedSpacing(count: number, at: (i: number, axis: number) => number,
                                 scale: number, cell: number): number {
  if (count < 2) return cell;
  const cells = new Set<number>();
  const stride = Math.max(1, Math.floor(count / 20000));
  for (let i = 0; i < count; i += stride) {
    const x = Math.floor(at(i, 0) * scale / cell) & 1023;
    const y = Math.floor(at(i, 1) * scale / cell) & 1023;
    const z = Math.floor(at(i, 2) * scale / cell) & 1023;
    cells.add((x * 1024 + y) * 1024 + z);
  }
  return Math.min(cell, cell * Math.sqrt(cells.size / count));
}
