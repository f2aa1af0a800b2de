import {
  parseFramesFile, parseMapInfo, parseServerStatus, ProtocolError, type FramesFile, type MapInfo,
} from './protocol';

async function json(path: string): Promise<unknown> {
  const response = await fetch(path, { cache: 'no-cache' });
  if (!response.ok) throw new Error(`${path}: ${response.status} ${response.statusText}`.trim());
  try {
    return await response.json();
  } catch {
    throw new ProtocolError(`${path} is not JSON`);
  }
}

export async function loadMapInfo(): Promise<MapInfo> {
  return parseMapInfo(await json('map.json'));
}

export async function loadFrames(path: string): Promise<FramesFile> {
  return parseFramesFile(await json(path));
}

const pause = (milliseconds: number) =>
  new Promise((resolve) => { setTimeout(resolve, milliseconds); });

/** Until the server has read the map.
 *  @param path  of what tells how far it is; null: an exported folder, nothing to wait for
 *  @return what of the map cannot be read, or null */
export async function untilReady(
  path: string | null, progress: (read: number) => void,
): Promise<string | null> {
  if (path === null) return null;
  for (;;) {
    const status = parseServerStatus(await json(path));
    if (status.state === 'ready' || status.failure !== null) return status.failure;
    progress(status.read);
    await pause(200);
  }
}

/** Why the server has no image for a path: one sentence. */
export async function whyNoImage(path: string): Promise<string> {
  try {
    const { status } = await fetch(path, { cache: 'no-cache' });
    return status === 410 ? 'The image is no longer kept.' : 'The frame has no image of this camera.';
  } catch {
    return 'The server does not answer.';
  }
}

export function imagePath(frame: number, camera: number): string {
  return `images/${frame}/${camera}.jpg`;
}
