import { Vector3 } from 'three';

import { Budget } from './budget';
import { el, short } from './dom';
import { MapScene } from './map_scene';
import { DepthProbe } from './depth_probe';
import { Navigation } from './navigation/navigation';
import { matrixOfView, place } from './navigation/view';
import { chasing } from './navigation/walk';
import { Notices } from './notices';
import type { Frame, MapInfo } from './protocol';
import { RenderLoop } from './render_loop';
import { defaultSettings, type Settings } from './settings';
import { Store } from './store';
import { backgroundOf, ThemeChoice } from './theme';
import { TileLayer } from './tile_layer';
import { Trajectory } from './trajectory';

export class Viewer {
  private readonly settings = new Store<Settings>(defaultSettings);
  private readonly notices = new Notices();
  private readonly canvas = el('canvas', { tabindex: 0, 'aria-label': 'The map in 3D' });
  private readonly scene = new MapScene(this.canvas);
  private readonly probe = new DepthProbe(this.scene.eyeDome.target.depthTexture!);
  private readonly budget = new Budget();
  private readonly trajectory: Trajectory;
  private readonly navigation: Navigation;
  private readonly loop = new RenderLoop((seconds) => this.step(seconds));
  private tiles: TileLayer | null = null;
  private row = 0;

  constructor(root: HTMLElement, map: MapInfo, frames: Frame[]) {
    this.trajectory = new Trajectory(frames);
    root.replaceChildren(el('div', { class: 'viewer' }, this.canvas,
      el('header', { class: 'top' }, el('div', { class: 'title card' },
        el('h1', {}, map.name), el('p', {}, `${short(map.points)} points`))),
      this.notices.element));
    this.navigation = new Navigation(this.canvas, {
      probe: (x, y) => this.probe.at(this.scene.renderer, this.scene.camera, x, y),
      pixelsPerUnit: () => this.scene.pixelsPerUnit / this.scene.ratio,
      trajectory: this.trajectory,
      row: () => this.row,
      setRow: (row) => { this.row = row; this.loop.invalidate(); },
      changed: () => this.loop.invalidate(),
      moved: () => undefined,
      click: () => undefined,
    });
    new ThemeChoice((theme) => {
      this.scene.setBackground(...backgroundOf(theme));
      this.loop.invalidate();
    });
    this.settings.listen((settings) => {
      this.scene.materials.choose(settings);
      this.scene.eyeDome.setStrength(settings.eyeDome ? settings.eyeDomeStrength : 0);
      this.loop.invalidate();
    });
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.resize();
    if (map.tileset) this.addTiles(map.tileset);
    this.navigation.setView(chasing(this.trajectory, 0));
  }

  private addTiles(url: string): void {
    this.tiles = new TileLayer(url, this.scene.materials, {
      changed: () => this.loop.invalidate(),
      firstTile: () => undefined,
      failed: (count, error) => this.notices.show('tiles', {
        text: `${count} ${count === 1 ? 'tile' : 'tiles'} could not be loaded: ${error.message}`,
        action: { label: 'Try again', run: () => this.tiles?.retryFailed() },
      }),
    });
    this.scene.add(this.tiles.group);
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    this.scene.setSize(clientWidth, clientHeight, Math.min(devicePixelRatio, 2));
    this.loop.invalidate();
  }

  private step(seconds: number | null): boolean {
    this.navigation.step(Math.min(seconds ?? 0.016, 0.1), false);
    const { scene } = this;
    scene.camera.aspect = scene.width / scene.height;
    scene.camera.updateProjectionMatrix();
    place(scene.camera, matrixOfView(this.navigation.view));
    const { canvas } = this;
    this.tiles?.update(scene.camera, canvas.width, canvas.height, this.budget.points);
    const limited = this.tiles?.limited ?? false;
    if (seconds === null) this.budget.pause();
    else this.budget.frame(1000 * seconds, limited);
    scene.draw();
    const loading = (this.tiles?.loading ?? 0) > 0;
    return this.navigation.moving || loading || limited && this.budget.mayGrow;
  }

  get pivotDistance(): number {
    return this.navigation.view.eye.distanceTo(new Vector3());
  }
}
