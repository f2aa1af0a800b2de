import { Vector3, type Box3 } from 'three';

import { AddressBar, stateOf, tripleOf, type AddressState } from './address';
import { Budget } from './budget';
import { CitySection, figuresOfCity } from './city_section';
import { modesOf, type DataRanges } from './color_modes';
import { Compass } from './compass';
import { DepthProbe } from './depth_probe';
import { el, short } from './dom';
import { FovealOverlay } from './foveal_overlay';
import { FrameView } from './frame_view';
import type { Graphics } from './graphics';
import { Help } from './help';
import { ImageComparison } from './image_comparison';
import type { Rectangle } from './intrinsics';
import { TopBar } from './layout';
import { LiveView } from './live_view';
import { MapScene } from './map_scene';
import { Navigation, type NavigationMode } from './navigation/navigation';
import {
  forwardOf, matrixOfView, overviewOf, place, viewAlong, viewOfMatrix, type View,
} from './navigation/view';
import { chasing } from './navigation/walk';
import { Notices, showInstead } from './notices';
import { Panel } from './panel';
import { localPosition } from './picking';
import type { PointObject } from './point_object';
import { PointTools } from './point_tools';
import type { Frame, MapInfo } from './protocol';
import { RenderLoop } from './render_loop';
import { saveImage } from './screenshot';
import { loadFrames, loadMapInfo } from './server';
import { defaultSettings, showsUncolored, type Settings } from './settings';
import { listenToKeys, type Shortcuts } from './shortcuts';
import { Store } from './store';
import type { PageState, PickedState } from './test_hook';
import { backgroundOf, ThemeChoice } from './theme';
import { TileLayer } from './tile_layer';
import { Timeline } from './timeline';
import { Trajectory } from './trajectory';
import { TrajectoryLine } from './trajectory_line';

/** Below this width (CSS pixels) the settings are a sheet that is closed at first. */
const narrow = 760;
const toggles = ['trajectory', 'foveal', 'rays'] as const;
/** Rays are found again at most this often while tiles come and go (ms). */
const rayPause = 300;
/** How long nothing moves before the picture becomes finer (ms). */
const restAfter = 400;
/** While it does, it is drawn at most this often (ms). */
const restPause = 500;
/** Levels of tiles come one after another, with steps between in which nothing is on its way. */
const stepsToSettle = 4;

/** Puts the parts together: what is drawn, who moves the camera, what the panels say. */
export class Viewer {
  private readonly settings: Store<Settings>;
  private readonly notices = new Notices();
  private readonly canvas = el('canvas', { tabindex: 0, 'aria-label': 'The map in 3D' });
  private readonly status = el('p', { class: 'status' });
  private readonly bottom: HTMLElement;
  private readonly element: HTMLElement;
  private readonly scene: MapScene;
  private readonly probe: DepthProbe;
  private readonly budget = new Budget();
  private readonly trajectory: Trajectory;
  private readonly navigation: Navigation;
  private readonly loop = new RenderLoop((seconds) => this.step(seconds));
  private readonly theme: ThemeChoice;
  private readonly topBar: TopBar;
  private readonly panel: Panel;
  private readonly timeline: Timeline;
  private readonly help: Help;
  private readonly frameView: FrameView;
  private readonly tools: PointTools;
  private readonly line: TrajectoryLine;
  private readonly foveal: FovealOverlay;
  private readonly comparison: ImageComparison;
  private readonly compass = new Compass(() => this.turnNorth());
  private readonly citySection: CitySection | null;
  private readonly address = new AddressBar(() => this.addressState());
  private tiles: TileLayer | null = null;
  private live: LiveView | null = null;
  private ranges: DataRanges;
  private row = 0;
  private playing = false;
  /** In a live map: whether the current frame is always the newest. */
  private atEnd = true;
  /** ... and whether the camera has been taken to it. */
  private seesDrive = false;
  private raysStale = true;
  private raysAt = -Infinity;
  private drawnAt = -Infinity;
  private restTimer = 0;
  private settledSteps = 0;

  constructor(private readonly root: HTMLElement, private map: MapInfo, frames: Frame[],
              graphics: Graphics) {
    this.settings = new Store(defaultSettings(graphics.software));
    this.scene = new MapScene(this.canvas, !graphics.software);
    this.probe = new DepthProbe(this.scene.eyeDome.target.depthTexture!);
    this.trajectory = new Trajectory(frames);
    if (map.foveal) this.scene.materials.setFovea(map.foveal.near, map.foveal.far);
    this.ranges = { height: [-2, 8], frame: [0, 1] };
    this.navigation = this.makeNavigation();
    this.topBar = this.makeTopBar();
    this.citySection = map.city &&
      new CitySection(map, map.city, (drive) => this.lookAtDrive(drive));
    this.panel = new Panel(map, this.settings, this.citySection?.element);
    this.panel.element.hidden = innerWidth < narrow;
    this.timeline = new Timeline(this.trajectory, {
      setRow: (row) => this.setRow(row),
      setPlaying: (playing) => this.setPlaying(playing),
      setFollow: (follow) => this.settings.set({ follow }),
    });
    this.help = new Help(map.generator);
    this.frameView = new FrameView(map, this.trajectory, {
      changed: () => this.loop.invalidate(),
      close: () => this.leaveFrame(),
      step: (frames_) => this.stepFrame(frames_),
    });
    this.tools = new PointTools(this.scene, map, this.trajectory,
      (frame, camera) => this.lookFrom(frame, camera),
      (x, y) => this.probe.at(this.scene.renderer, this.scene.camera, x, y));
    this.line = new TrajectoryLine(this.trajectory);
    this.foveal = new FovealOverlay(map);
    this.comparison = new ImageComparison(this.scene, () => this.loop.invalidate(),
      (why) => this.notices.show('image', { text: `${why} Nothing is compared.` }, 6));
    this.scene.lines.add(this.line.group, this.foveal.group);
    this.bottom = el('footer', { class: 'bottom' }, this.status, this.timeline.element);
    this.element = el('div', { class: 'viewer' }, this.canvas, this.frameView.element,
      this.tools.labels, map.origin ? this.compass.element : '', this.topBar.element, this.panel.element, this.tools.card.element,
      this.bottom, this.notices.element, this.help.element);
    root.replaceChildren(this.element);
    this.theme = new ThemeChoice((theme) => {
      this.scene.setBackground(...backgroundOf(theme));
      this.timeline.draw();
      this.live?.strip.draw();
      this.loop.invalidate();
    });
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    new ResizeObserver(() => this.element.style.setProperty(
      '--bottom', `${this.bottom.offsetHeight}px`)).observe(this.bottom);
    this.canvas.addEventListener('webglcontextlost', (event) => this.lostContext(event));
    listenToKeys(this.shortcuts(), this.navigation);
    this.resize();
    this.framesChanged();
    if (map.live) this.goLive();
    else if (map.tileset) this.tiles = this.makeTiles(map.tileset);
    if (this.tiles) this.scene.add(this.tiles.group);
    if (!map.live && map.points === 0) this.sayEmpty();
    if (map.city) this.settings.set({ follow: false });
    else this.navigation.setView(chasing(this.trajectory, 0));
    this.restore(stateOf(location.hash));
    window.addEventListener('hashchange', () => this.restore(stateOf(location.hash)));
    this.settings.listen((now) => this.apply(now));
  }

  /** Tells of something that does not keep the map from being shown. */
  warn(text: string): void {
    this.notices.show('warning', { text });
  }

  /** Of a city: the paths of its drives. */
  async loadPaths(): Promise<void> {
    try {
      const { frames, failures } = await loadFrames(this.map.frames);
      for (const frame of frames) this.trajectory.put(frame);
      this.framesChanged();
      this.citySection?.setPaths(new Set(frames.map(({ drive }) => drive ?? 0)));
      if (failures.length > 0) this.notices.show('failures', { text: failures.join('\n') });
    } catch (error) {
      this.notices.show('failures', {
        text: `The paths of the drives cannot be read: ${(error as Error).message}`,
      });
    }
  }

  state(): PageState {
    const { camera } = this.scene;
    const live = this.live?.session ?? null;
    return {
      pointsDrawn: this.scene.pointsDrawn,
      trianglesDrawn: this.scene.trianglesDrawn,
      pointsLoaded: (this.tiles?.pointsLoaded ?? 0) + (live?.layer.points ?? 0),
      budget: this.budget.points,
      fps: this.budget.fps,
      mode: this.settings.get().mode,
      frame: this.frame?.index ?? null,
      tilesLoading: this.tiles?.loading ?? 0,
      atRest: this.loop.idle && this.restTimer === 0 && (this.tiles?.loading ?? 0) === 0,
      live: live && {
        connected: live.connected, frames: live.frames, lastLatencyMs: live.lastLatencyMs,
        reconnects: live.reconnects, warnings: live.warnings,
      },
      measured: this.tools.measure.lengths,
      picked: this.tools.pickedState,
      camera: {
        pose: camera.matrixWorld.clone().transpose().toArray(),
        projection: camera.projectionMatrix.clone().transpose().toArray(),
      },
    };
  }

  pick(x: number, y: number): PickedState | null {
    return this.tools.at(x, y);
  }

  private get frame(): Frame | undefined {
    return this.trajectory.frame(Math.round(this.row));
  }

  private get wide(): boolean {
    return innerWidth >= narrow;
  }

  // --- parts ---

  private makeNavigation(): Navigation {
    return new Navigation(this.canvas, {
      probe: (x, y) => this.probe.at(this.scene.renderer, this.scene.camera, x, y),
      pixelsPerUnit: () => this.scene.pixelsPerUnit / this.scene.ratio,
      trajectory: this.trajectory,
      row: () => this.row,
      setRow: (row) => this.setRow(row),
      changed: () => this.wake(),
      moved: () => this.settings.set({ follow: false }),
      click: (x, y) => this.click(x, y),
      doubleClick: (x, y) => {
        if (this.tools.measuring) this.click(x, y);
        else this.navigation.approach(x, y);
      },
    });
  }

  private makeTopBar(): TopBar {
    return new TopBar(this.map, {
      navigate: (mode) => this.navigate(mode),
      frameView: () => this.toggleFrameView(),
      measure: () => this.setMeasuring(!this.tools.measuring),
      copyLink: () => void this.copyLink(),
      saveImage: () => this.saveImage(),
      theme: () => this.theme.toggle(),
      fullScreen: () => this.toggleFullScreen(),
      help: () => this.help.toggle(),
      panel: () => this.togglePanel(),
    });
  }

  private makeTiles(url: string): TileLayer {
    return new TileLayer(url, this.scene.materials, {
      changed: () => {
        this.raysStale = true;
        this.loop.invalidate();
      },
      begins: (box) => this.seeCity(box),
      firstTile: (points) => {
        this.measureHeights(points);
        if (!points.known) this.sayPlain();
      },
      failed: (count, error) => this.notices.show('tiles', {
        text: `${count} ${count === 1 ? 'tile' : 'tiles'} could not be loaded: ` +
          (error instanceof TypeError ? 'the server does not answer.' : error.message),
        action: {
          label: 'Try again',
          run: () => {
            this.notices.clear('tiles');
            this.tiles?.retryFailed();
          },
        },
      }),
    });
  }

  private shortcuts(): Shortcuts {
    const set = (change: Partial<Settings>) => this.settings.set(change);
    const get = () => this.settings.get();
    return new Map<string, () => void>([
      ['1', () => this.navigate('orbit')],
      ['2', () => this.navigate('fly')],
      ['3', () => this.navigate('walk')],
      [' ', () => this.setPlaying(!this.playing)],
      [',', () => this.stepFrame(-1)],
      ['.', () => this.stepFrame(1)],
      ['[', () => this.stepMode(-1)],
      [']', () => this.stepMode(1)],
      ['?', () => this.help.toggle()],
      ['Escape', () => this.escape()],
      ['Backspace', () => {
        this.tools.measure.undo();
        this.loop.invalidate();
      }],
      ['KeyI', () => this.toggleFrameView()],
      ['KeyC', () => set({ follow: !get().follow })],
      ['KeyM', () => this.setMeasuring(!this.tools.measuring)],
      ['KeyU', () => set(get().mode === 'photograph' ?
        { uncoloredInPhotograph: !get().uncoloredInPhotograph } :
        { uncoloredElsewhere: !get().uncoloredElsewhere })],
      ['KeyL', () => set({ eyeDome: !get().eyeDome })],
      ['KeyR', () => this.resetView()],
      ['KeyP', () => this.saveImage()],
      ['KeyH', () => this.togglePanel()],
      ['KeyT', () => this.theme.toggle()],
    ]);
  }

  // --- settings and places ---

  private apply(now: Settings): void {
    this.scene.materials.choose(now);
    this.scene.materials.scale(now, this.ranges);
    this.scene.eyeDome.setStrength(now.eyeDome ? now.eyeDomeStrength : 0);
    this.budget.fix(now.fixedBudget);
    this.timeline.setFollow(now.follow);
    this.showLegend();
    if (now.mode !== 'error') this.comparison.stop();
    this.placeChanged();
  }

  private setRanges(change: Partial<DataRanges>): void {
    this.ranges = { ...this.ranges, ...change };
    this.scene.materials.scale(this.settings.get(), this.ranges);
    this.showLegend();
  }

  private showLegend(): void {
    const layer = this.tiles ?? this.live?.session.layer;
    this.panel.setLegend(this.ranges, layer?.cameras ?? new Set());
  }

  /** Colours for the heights that most points have. */
  private measureHeights(points: PointObject): void {
    const heights: number[] = [];
    const stride = Math.max(1, Math.floor(points.pointCount / 5000));
    for (let i = 0; i < points.pointCount; i += stride) heights.push(localPosition(points, i).z);
    heights.sort((a, b) => a - b);
    const at = (share: number) => heights[Math.floor(share * (heights.length - 1))]!;
    if (heights.length === 0) return;
    this.setRanges({ height: [at(0.02), Math.max(at(0.98), at(0.02) + 1)] });
  }

  private framesChanged(): void {
    this.timeline.update();
    this.line.update();
    const { length } = this.trajectory;
    this.setRanges({
      frame: [this.trajectory.frame(0)?.index ?? 0, this.trajectory.frame(length - 1)?.index ?? 1],
    });
    this.setRow(this.row);
  }

  private setRow(row: number): void {
    this.row = Math.min(Math.max(row, 0), Math.max(this.trajectory.length - 1, 0));
    this.atEnd = this.row >= this.trajectory.length - 1;
    this.timeline.show(this.row);
    if (this.frameView.active) this.frameView.open(Math.round(this.row), null);
    this.placeChanged();
  }

  /** The current frame or what is shown of it has changed. */
  private placeChanged(): void {
    const now = this.settings.get();
    const pose = this.trajectory.pose(Math.round(this.row));
    this.line.group.visible = now.trajectory;
    this.line.show(this.row);
    if (pose) this.foveal.place(pose, now.foveal);
    if (now.mode === 'error' && this.map.cameras.length > 0) {
      this.comparison.choose(this.trajectory, Math.round(this.row),
        this.frameView.camera ?? this.map.cameras[0]!);
    }
    this.raysStale = true;
    this.topBar.show(this.navigation.mode, this.frameView.active, this.tools.measuring,
      !this.panel.element.hidden);
    this.loop.invalidate();
  }

  private setPlaying(playing: boolean): void {
    const last = this.trajectory.length - 1;
    if (playing && this.row >= last) this.setRow(0);
    this.playing = playing && last > 0;
    this.timeline.setPlaying(this.playing);
    this.loop.invalidate();
  }

  private stepFrame(frames: number): void {
    this.setPlaying(false);
    this.setRow(Math.round(this.row) + frames);
  }

  private stepMode(step: number): void {
    const modes = modesOf(this.map);
    const at = modes.indexOf(this.settings.get().mode);
    this.settings.set({ mode: modes[(at + step + modes.length) % modes.length]! });
  }

  private navigate(mode: NavigationMode): void {
    this.leaveFrame();
    this.navigation.setMode(mode);
    this.placeChanged();
  }

  /** The first view of a city, unless the address has one. */
  private seeCity(box: Box3): void {
    if (!this.map.city || box.isEmpty()) return;
    this.scene.setReach(box.getSize(new Vector3()).length());
    if (!stateOf(location.hash).at) this.navigation.setView(this.homeView());
  }

  private homeView(): View {
    const box = this.map.city ? this.tiles?.box : null;
    return box && !box.isEmpty() ? overviewOf(box, this.scene.camera.fov) :
      chasing(this.trajectory, this.row);
  }

  private lookAtDrive(drive: number): void {
    const row = this.trajectory.all().findIndex((frame) => frame.drive === drive);
    if (row < 0) return;
    this.setRow(row);
    this.leaveFrame();
    this.navigation.setMode('orbit');
    this.navigation.flyTo(chasing(this.trajectory, row));
    this.placeChanged();
  }

  private turnNorth(): void {
    const { eye, pitch } = this.navigation.view;
    this.navigation.flyTo({ eye: eye.clone(), yaw: Math.PI / 2, pitch });
  }

  private resetView(): void {
    this.leaveFrame();
    this.navigation.setMode('orbit');
    this.navigation.flyTo(this.homeView());
    this.placeChanged();
  }

  private escape(): void {
    if (this.frameView.active) this.leaveFrame();
    else if (this.tools.measuring) this.setMeasuring(false);
    else this.tools.drop();
  }

  private togglePanel(): void {
    this.panel.element.hidden = !this.panel.element.hidden;
    this.placeChanged();
  }

  private toggleFullScreen(): void {
    if (document.fullscreenElement) void document.exitFullscreen();
    else void this.root.requestFullscreen().catch(() => undefined);
  }

  // --- the frame's own view ---

  private toggleFrameView(): void {
    if (this.frameView.active) this.leaveFrame();
    else this.lookFrom(this.frame?.index ?? 0, null);
  }

  private lookFrom(frame: number, camera: number | null): void {
    const row = this.trajectory.row(frame);
    if (row === undefined) return;
    this.setPlaying(false);
    this.settings.set({ follow: false });
    if (this.map.cameras.length === 0) {
      const pose = this.trajectory.pose(row)!;
      this.setRow(row);
      this.navigation.setMode('fly');
      this.navigation.flyTo(viewAlong(new Vector3().setFromMatrixPosition(pose),
        new Vector3().setFromMatrixColumn(pose, 0)));
      if (!this.map.city) this.notices.show('no-images', {
        calm: true,
        text: 'From the LiDAR, forward. For the cameras and their images the drive must be at ' +
          'hand: fovea view MAP --drive DRIVE',
      }, 12);
      return this.placeChanged();
    }
    if (!this.wide) this.panel.element.hidden = true;
    this.frameView.open(row, camera);
    this.navigation.hands = {
      pan: (dx, dy) => this.frameView.pan(dx, dy),
      zoom: (factor, x, y) => this.frameView.magnify(factor, x, y),
    };
    this.setRow(row);
  }

  private leaveFrame(): void {
    if (!this.frameView.active) return;
    const view = viewOfMatrix(this.frameView.pose());
    this.frameView.close();
    this.navigation.hands = null;
    if (this.navigation.mode === 'walk') this.navigation.setMode('walk', view);
    else this.navigation.setView(view);
    this.placeChanged();
  }

  /** Where the image may lie, free of bars and panel. */
  private frameArea(): Rectangle {
    const side = this.wide ? 12 : 0;
    const right = this.wide && !this.panel.element.hidden ? 292 : side;
    const top = this.wide ? 118 : 142;
    return {
      x: side, y: top,
      width: Math.max(60, this.scene.width - side - right),
      height: Math.max(60, this.scene.height - top - this.bottom.offsetHeight - 24),
    };
  }

  // --- picking and measuring ---

  private click(x: number, y: number): void {
    this.tools.click(x, y);
    this.loop.invalidate();
  }

  private setMeasuring(measuring: boolean): void {
    this.tools.setMeasuring(measuring);
    this.element.classList.toggle('picks', measuring);
    if (measuring) {
      this.notices.show('measure', { text: 'Click two or more points.', calm: true }, 5);
    } else {
      this.notices.clear('measure');
    }
    this.placeChanged();
  }

  // --- links and pictures ---

  private addressState(): AddressState {
    const now = this.settings.get();
    const { view, mode } = this.navigation;
    const camera = this.frameView.camera?.index;
    const show = [
      ...toggles.filter((name) => now[name]), ...(showsUncolored(now) ? ['uncolored'] : []),
    ];
    // A link to the newest of a growing map leads to what is the newest then.
    const newest = this.map.live && this.atEnd && now.follow;
    const place = newest ? {} : {
      at: tripleOf(view.eye),
      to: tripleOf(view.eye.clone().addScaledVector(forwardOf(view), 10)),
      ...(this.frame && { frame: this.frame.index }),
    };
    return {
      ...place,
      mode: now.mode,
      navigation: mode,
      ...(camera !== undefined && { camera }),
      show,
      line: this.tools.measure.corners.map(tripleOf),
    };
  }

  private restore(state: AddressState): void {
    if (state.camera === undefined) this.leaveFrame();
    const { mode, show } = state;
    if (mode && modesOf(this.map).includes(mode)) this.settings.set({ mode });
    if (show) {
      const uncolored = show.includes('uncolored');
      this.settings.set({
        trajectory: show.includes('trajectory'),
        foveal: show.includes('foveal'),
        rays: show.includes('rays'),
        ...(this.settings.get().mode === 'photograph' ?
          { uncoloredInPhotograph: uncolored } : { uncoloredElsewhere: uncolored }),
      });
    }
    if (state.frame !== undefined && this.trajectory.length > 0) {
      this.setRow(this.trajectory.nearestRow(state.frame));
    }
    if (state.line) this.tools.setLine(state.line);
    if (state.at && state.to) {
      const eye = new Vector3(...state.at);
      const view = viewAlong(eye, new Vector3(...state.to).sub(eye));
      this.settings.set({ follow: false });
      this.navigation.setMode(state.navigation ?? 'orbit', view);
      this.navigation.setView(view);
    }
    if (state.camera !== undefined && this.frame) this.lookFrom(this.frame.index, state.camera);
    this.placeChanged();
  }

  private async copyLink(): Promise<void> {
    this.address.write();
    try {
      await navigator.clipboard.writeText(location.href);
      this.notices.show('link', { text: 'The link to this view is copied.', calm: true }, 3);
    } catch {
      this.notices.show('link', { text: 'Copy the link from the address bar.', calm: true }, 5);
    }
  }

  private saveImage(): void {
    this.scene.draw();
    const frame = this.frame ? `_${this.frame.index}` : '';
    saveImage(this.canvas, `${this.map.name}${frame}.png`);
  }

  // --- a map that grows ---

  private goLive(): void {
    this.atEnd = true;
    this.live = new LiveView(this.map, this.scene.materials, this.trajectory, this.notices, {
      changed: () => {
        this.raysStale = true;
        this.loop.invalidate();
      },
      framesChanged: () => this.liveFramesChanged(),
      restarted: () => {
        void this.reloadIfOther();
        this.tools.drop();
        this.tools.setLine([]);
        this.row = 0;
        this.atEnd = true;
        this.seesDrive = false;
      },
      points: (count) => this.topBar.setFigures(`live, ${short(count)} points`),
      ended: () => void this.finish(),
    });
    this.bottom.prepend(this.live.strip.element);
    this.scene.add(this.live.session.layer.group);
  }

  private liveFramesChanged(): void {
    const { length } = this.trajectory;
    if (this.atEnd) this.row = Math.max(length - 1, 0);
    this.framesChanged();
    if (length === 0) return;
    const { z } = this.trajectory.position(length - 1);
    this.setRanges({ height: [Math.round(z) - 3, Math.round(z) + 7] });
    if (this.seesDrive) return;
    this.seesDrive = true;
    if (this.settings.get().follow) this.navigation.setView(chasing(this.trajectory, this.row));
  }

  /** Another run of the same program may be of another drive. */
  private async reloadIfOther(): Promise<void> {
    const before = this.map;
    const now = await loadMapInfo().catch(() => before);
    const same = now.name === before.name && now.tileSize === before.tileSize &&
      JSON.stringify(now.cameras) === JSON.stringify(before.cameras);
    if (!same) location.reload();
  }

  /** The drive has ended: the finished map takes over as soon as it has this view ready. */
  private async finish(): Promise<void> {
    try {
      this.map = await loadMapInfo();
      const { frames } = await loadFrames(this.map.frames);
      this.trajectory.clear();
      for (const frame of frames) this.trajectory.put(frame);
      this.framesChanged();
    } catch (error) {
      this.notices.show('live', {
        text: `The drive has ended, but its map cannot be read: ${(error as Error).message}`,
        action: { label: 'Reload', run: () => location.reload() },
      });
      return;
    }
    this.topBar.setLive(false);
    this.notices.show('end', { text: 'The drive has ended. The map is finished.', calm: true }, 8);
    if (!this.map.tileset) return;
    this.tiles = this.makeTiles(this.map.tileset);
    this.tiles.group.visible = false;
    this.scene.add(this.tiles.group);
    this.budget.rest();
    this.loop.invalidate();
  }

  private takeOver(): void {
    if (!this.tiles || this.tiles.group.visible) return;
    this.settledSteps = this.tiles.settled ? this.settledSteps + 1 : 0;
    if (this.settledSteps < stepsToSettle) return;
    this.tiles.group.visible = true;
    this.tools.drop();
    if (this.live) this.scene.remove(this.live.session.layer.group);
    this.live?.clear();
    this.live = null;
    this.raysStale = true;
  }

  // --- drawing ---

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    this.scene.setSize(clientWidth, clientHeight, Math.min(devicePixelRatio, 2));
    this.line.setResolution(clientWidth, clientHeight);
    this.tools.measure.setResolution(clientWidth, clientHeight);
    this.loop.invalidate();
  }

  private step(seconds: number | null): boolean {
    const passed = Math.min(seconds ?? 0.016, 0.1);
    if (this.playing) this.advance(passed);
    const { follow } = this.settings.get();
    this.navigation.step(passed, follow && !this.frameView.active && this.trajectory.length > 0);
    this.placeCamera();
    const limited = this.tiles?.limited ?? false;
    const behind = follow && this.navigation.mode !== 'walk' && !this.frameView.active &&
      this.trajectory.length > 0 && this.navigation.distanceToChase() > 0.02;
    const moving = this.playing || this.navigation.moving || behind;
    if (moving) this.budget.wake();
    this.updateTiles(seconds);
    const loading = (this.tiles?.loading ?? 0) > 0 || this.tiles?.group.visible === false;
    // A first picture of nothing would only keep the first tile waiting.
    if (this.tiles?.awaitsFirst && !this.live) return true;
    if (loading && this.budget.atRest && performance.now() - this.drawnAt < restPause) return true;
    this.updateRays();
    this.draw();
    this.drawnAt = performance.now();
    this.canvas.classList.add('drawn');
    this.address.touch();
    this.showStatus();
    const on = moving || loading || limited && this.budget.mayGrow;
    if (!on && limited && !this.budget.atRest) this.restSoon();
    return on;
  }

  /** The user moves something: now the picture must be quick. */
  private wake(): void {
    this.cancelRest();
    this.budget.wake();
    this.loop.invalidate();
  }

  private cancelRest(): void {
    clearTimeout(this.restTimer);
    this.restTimer = 0;
  }

  private restSoon(): void {
    this.cancelRest();
    this.restTimer = window.setTimeout(() => {
      this.restTimer = 0;
      this.budget.rest();
      this.loop.invalidate();
    }, restAfter);
  }

  private advance(seconds: number): void {
    const row = this.trajectory.rowAfter(
      this.row, seconds * this.timeline.speed, this.map.sensorPeriod);
    this.setRow(row);
    if (row >= this.trajectory.length - 1) this.setPlaying(false);
  }

  private placeCamera(): void {
    const { camera, width, height } = this.scene;
    if (this.frameView.active) {
      camera.projectionMatrix.copy(this.frameView.projection(width, height, this.frameArea()));
      camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
      place(camera, this.frameView.pose());
      return;
    }
    camera.aspect = width / height;
    camera.fov = camera.aspect < 1 ? 75 : 60;
    camera.updateProjectionMatrix();
    place(camera, matrixOfView(this.navigation.view));
  }

  private updateTiles(seconds: number | null): void {
    const { camera } = this.scene;
    if (this.tiles) {
      const { comparison } = this;
      this.tiles.setExtraCamera(comparison.active ? comparison.camera : null,
        comparison.width, comparison.height, camera);
      this.tiles.update(camera, this.canvas.width, this.canvas.height, this.budget.points);
      this.takeOver();
      if (this.tiles.isEmpty) this.sayEmpty();
    }
    if (seconds === null) this.budget.pause();
    else this.budget.frame(1000 * seconds, this.tiles?.limited ?? false);
  }

  private updateRays(): void {
    if (!this.settings.get().rays) return this.foveal.clearRays();
    const now = performance.now();
    if (!this.raysStale || now - this.raysAt < rayPause) return;
    const row = Math.round(this.row);
    const pose = this.trajectory.pose(row);
    if (!pose || !this.frame) return;
    this.foveal.showRays(this.frame.index, pose, this.scene.drawnObjects());
    this.raysStale = false;
    this.raysAt = now;
  }

  private draw(): void {
    const { camera, width, height } = this.scene;
    this.line.seenFrom(camera.position, this.navigation.mode === 'walk' || this.frameView.active);
    if (this.comparison.active) this.comparison.drawDepth();
    this.scene.draw();
    this.live?.session.drawn();
    this.tools.place(camera, width, height);
    this.compass.show(this.navigation.view.yaw);
  }

  private showStatus(): void {
    const { pointsDrawn, trianglesDrawn } = this.scene;
    const parts = [this.map.mesh ? `${short(trianglesDrawn)} triangles drawn` :
      `${short(pointsDrawn)} points drawn`];
    if (this.budget.fps > 0) parts.push(`${Math.round(this.budget.fps)} fps`);
    const loading = this.tiles?.loading ?? 0;
    if (loading > 0) parts.push(`${loading} tiles on their way`);
    this.status.textContent = parts.join(' · ');
    this.panel.setBudget(this.budget.points);
    if (!this.map.live) {
      const { length } = this.trajectory;
      this.topBar.setFigures(this.map.city ? figuresOfCity(this.map, this.map.city) :
        `${short(this.map.points)} points, ${length} frames`);
    }
  }

  private sayPlain(): void {
    this.notices.show('plain', {
      calm: true,
      text: 'These tiles have positions and colours alone: frame, range and rule are not known.',
    }, 8);
  }

  private sayEmpty(): void {
    this.notices.show('empty', {
      text: this.map.city ? 'This city has no points.' :
        'This map has no points. Was the drive mapped to its end?',
    });
  }

  private lostContext(event: Event): void {
    event.preventDefault();
    this.loop.stop();
    this.live?.session.stop();
    showInstead(this.root, 'The graphics card has dropped the map',
      'It was reset, or too much was asked of it. The view is kept in the address.',
      { label: 'Load again', run: () => location.reload() });
  }
}

