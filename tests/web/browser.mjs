// Debian's headless Chromium, the program's server, and what tests ask of the viewer's page.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { setTimeout as sleep } from 'node:timers/promises';

import { chromium } from 'playwright-core';
import { PNG } from 'pngjs';

const switches = [
  '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync',
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader',  // WebGL without a graphics card
];

export async function launchBrowser() {
  return chromium.launch({ executablePath: '/usr/bin/chromium', headless: true, args: switches });
}

/// `fovea ARGUMENTS...`, which serves a map; waits for the address that it prints.
export async function serve(program, ...args) {
  const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  let said = '';
  const ended = once(child, 'exit');
  const url = await new Promise((resolve, reject) => {
    for (const stream of [child.stdout, child.stderr]) {
      stream.on('data', (text) => {
        said += text;
        const address = said.match(/http:\/\/[^ \n]+/);
        if (address) resolve(address[0]);
      });
    }
    void ended.then(([code]) => reject(new Error(`fovea ended with ${code}: ${said}`)));
  });
  return {
    url,
    port: Number(new URL(url).port),
    said: () => said,
    /// Ends it as Ctrl-C does; its exit code.
    async stop(signal = 'SIGINT') {
      child.kill(signal);
      return (await ended)[0];
    },
  };
}

/// The page in a browser's window, with all that it complains of.
export class MapPage {
  static async open(browser, url, { width = 960, height = 600, wait = true } = {}) {
    const context = await browser.newContext({
      viewport: { width, height }, colorScheme: 'light', reducedMotion: 'reduce',
    });
    const map = new MapPage(await context.newPage());
    await map.page.goto(url);
    if (wait) await map.comesTo('the map is drawn', (state) => state.pointsDrawn + state.trianglesDrawn > 0);
    return map;
  }

  constructor(page) {
    this.page = page;
    this.complaints = [];
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type())) this.complaints.push(message.text());
    });
    page.on('pageerror', (error) => this.complaints.push(error.message));
  }

  state() {
    return this.page.evaluate(() => window.fovea?.state() ?? null);
  }

  /// Waits until the page's state is as wanted; on a machine without a graphics card that takes long.
  async comesTo(what, wanted, patience = 120_000) {
    const end = Date.now() + patience;
    let state = null;
    while (Date.now() < end) {
      state = await this.state();
      if (state && wanted(state)) return state;
      await sleep(50);
    }
    assert.fail(`${what}: never; the page's state is ${JSON.stringify(state)}`);
  }

  /// Waits until the picture is at rest: nothing loads, nothing is still to be drawn. The page says so: on a
  /// busy machine seconds may pass between two frames, in which nothing changes either.
  settles() {
    return this.comesTo('the picture is at rest', (state) => state.atRest);
  }

  /// The map's picture, without the controls that lie over it.
  async picture() {
    await this.settles();
    const canvas = this.page.locator('canvas').first();
    const controls = await this.page.addStyleTag({
      content: '#app > * > *:not(canvas) { visibility: hidden !important; }',
    });
    const bytes = await canvas.screenshot();
    await controls.evaluate((style) => style.remove());
    return PNG.sync.read(bytes);
  }

  button(name) {
    return this.page.getByRole('button', { name });
  }

  mode(name) {
    return this.page.getByRole('button', { name, exact: true });
  }

  close() {
    return this.page.context().close();
  }
}

/// How many pixels of a picture are like `wanted(r, g, b)`.
export function countPixels(picture, wanted) {
  let count = 0;
  for (let i = 0; i < picture.data.length; i += 4) {
    count += wanted(picture.data[i], picture.data[i + 1], picture.data[i + 2]) ? 1 : 0;
  }
  return count;
}

/// How many pixels differ between two pictures by more than what lighting does.
export function countDifferent(a, b) {
  assert.deepEqual([a.width, a.height], [b.width, b.height]);
  let count = 0;
  for (let i = 0; i < a.data.length; i += 4) {
    const difference = Math.abs(a.data[i] - b.data[i]) + Math.abs(a.data[i + 1] - b.data[i + 1]) +
      Math.abs(a.data[i + 2] - b.data[i + 2]);
    count += difference > 48 ? 1 : 0;
  }
  return count;
}

/// Where a point of the local frame is seen, in CSS pixels of the window.
export function placeOf(state, [x, y, z], { width = 960, height = 600 } = {}) {
  const { pose, projection } = state.camera;
  const offset = [x - pose[3], y - pose[7], z - pose[11]];
  const view = [0, 1, 2].map((column) =>
    [0, 1, 2].reduce((sum, row) => sum + pose[4 * row + column] * offset[row], 0));
  const clip = [0, 1, 2, 3].map((row) => projection[4 * row] * view[0] +
    projection[4 * row + 1] * view[1] + projection[4 * row + 2] * view[2] + projection[4 * row + 3]);
  // Clicks are told of in whole pixels.
  return {
    x: Math.round((clip[0] / clip[3] + 1) / 2 * width),
    y: Math.round((1 - clip[1] / clip[3]) / 2 * height),
  };
}
