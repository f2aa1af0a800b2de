import './page.css';

import { graphicsOfBrowser } from './graphics';
import { Notices, showInstead } from './notices';
import { loadFrames, loadMapInfo, untilReady } from './server';
import { Viewer } from './viewer';

async function start(root: HTMLElement): Promise<void> {
  const graphics = graphicsOfBrowser();
  if (!graphics) {
    return showInstead(root, 'This browser cannot draw the map',
      'It needs WebGL 2, which this browser lacks or has switched off.');
  }
  const map = await loadMapInfo();
  document.title = `${map.name} - Fovea`;
  const waiting = new Notices();
  root.replaceChildren(waiting.element);
  const failure = await untilReady(map.status, (progress) => waiting.show('reading',
    { text: 'The map is being read for its coarse levels', progress, calm: true }));
  // A city is seen before the server has read the paths of all drives.
  const frames = map.city ? [] : (await loadFrames(map.frames)).frames;
  const viewer = new Viewer(root, map, frames, graphics);
  if (failure !== null) viewer.warn(failure);
  if (map.city) void viewer.loadPaths();
  window.fovea = { state: () => viewer.state(), pick: (x, y) => viewer.pick(x, y) };
}

const root = document.getElementById('app')!;
start(root).catch((error: unknown) => {
  const text = error instanceof TypeError ?
    'The server does not answer. Is fovea view still running?' :
    error instanceof Error ? error.message : String(error);
  showInstead(root, 'The map cannot be shown', text,
    { label: 'Try again', run: () => location.reload() });
});
