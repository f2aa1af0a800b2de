import './page.css';

import { showInstead } from './notices';
import { loadFrames, loadMapInfo, untilReady } from './server';
import { Viewer } from './viewer';

async function start(root: HTMLElement): Promise<void> {
  if (!document.createElement('canvas').getContext('webgl2')) {
    return showInstead(root, 'This browser cannot draw the map', 'It needs WebGL 2.');
  }
  const map = await loadMapInfo();
  document.title = `${map.name} - Fovea`;
  await untilReady(() => undefined);
  const frames = await loadFrames(map.frames);
  new Viewer(root, map, frames);
}

const root = document.getElementById('app')!;
start(root).catch((error: unknown) => {
  const text = error instanceof Error ? error.message : String(error);
  showInstead(root, 'The map cannot be shown', text,
    { label: 'Try again', run: () => location.reload() });
});
