import { Vector3 } from 'three';

import { colorModes, type ColorMode } from './color_modes';
import type { NavigationMode } from './navigation/navigation';

type Triple = readonly [number, number, number];

/** The view as a link has it. Everything may be missing. */
export interface AddressState {
  readonly at?: Triple;
  readonly to?: Triple;
  readonly frame?: number;
  readonly mode?: ColorMode;
  readonly navigation?: NavigationMode;
  /** The page looks from the frame with this camera. */
  readonly camera?: number;
  readonly show?: readonly string[];
  readonly line?: readonly Triple[];
}

const navigationModes: readonly NavigationMode[] = ['orbit', 'fly', 'walk'];

function text(triple: Triple): string {
  return triple.map((value) => Number(value.toFixed(3))).join(',');
}

function triple(value: string | null): Triple | undefined {
  const numbers = (value ?? '').split(',').map((part) => (part === '' ? NaN : Number(part)));
  return numbers.length === 3 && numbers.every(Number.isFinite) ?
    numbers as unknown as Triple : undefined;
}

function integer(value: string | null): number | undefined {
  return value !== null && /^-?\d{1,9}$/.test(value) ? Number(value) : undefined;
}

export function hashOf(state: AddressState): string {
  const parts: string[] = [];
  const put = (key: string, value: string) => parts.push(`${key}=${value}`);
  if (state.at) put('at', text(state.at));
  if (state.to) put('to', text(state.to));
  if (state.frame !== undefined) put('frame', String(state.frame));
  if (state.mode) put('mode', state.mode);
  if (state.navigation) put('move', state.navigation);
  if (state.camera !== undefined) put('camera', String(state.camera));
  if (state.show) put('show', state.show.join(','));
  if (state.line && state.line.length > 0) put('line', state.line.map(text).join(';'));
  return `#${parts.join('&')}`;
}

/** Whatever somebody typed: what makes no sense is left out. */
export function stateOf(hash: string): AddressState {
  const fields = new URLSearchParams(hash.replace(/^#/, ''));
  const mode = colorModes.find((name) => name === fields.get('mode'));
  const navigation = navigationModes.find((name) => name === fields.get('move'));
  const line = fields.get('line')?.split(';').map(triple);
  const [at, to] = [triple(fields.get('at')), triple(fields.get('to'))];
  const [frame, camera] = [integer(fields.get('frame')), integer(fields.get('camera'))];
  return {
    ...(at && { at }),
    ...(to && { to }),
    ...(frame !== undefined && { frame }),
    ...(mode && { mode }),
    ...(navigation && { navigation }),
    ...(camera !== undefined && { camera }),
    ...(fields.has('show') && { show: fields.get('show')!.split(',').filter(Boolean) }),
    ...(line?.every((point) => point !== undefined) && { line: line as Triple[] }),
  };
}

export function tripleOf(v: Vector3): Triple {
  return [v.x, v.y, v.z];
}

/** Keeps the address at the present view, not more often than browsers like it. */
export class AddressBar {
  private timer = 0;

  constructor(private readonly state: () => AddressState) {}

  touch(): void {
    if (this.timer !== 0) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.write();
    }, 500);
  }

  write(): void {
    const hash = hashOf(this.state());
    if (hash !== location.hash) history.replaceState(null, '', hash);
  }
}
