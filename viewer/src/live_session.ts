import { LiveLayer } from './live_layer';
import type { FrameMessage, HelloMessage, LiveMessage } from './live_message';
import { LiveSocket } from './live_socket';
import type { LiveFigures } from './live_strip';
import type { PointMaterials } from './point_material';
import type { Frame } from './protocol';
import type { Trajectory } from './trajectory';

export interface LiveSessionEvents {
  /** There is something new to draw. */
  changed(): void;
  framesChanged(): void;
  frame(frame: Frame): void;
  image(jpeg: Uint8Array<ArrayBuffer>, frame: number): void;
  figures(figures: LiveFigures): void;
  /** Another drive is mapped than before. */
  restarted(): void;
  connection(connected: boolean): void;
  odd(count: number): void;
  ended(): void;
}

/** Frames over which a rate is taken. */
const rateFrames = 20;

/** A map that grows: what the server sends becomes points, frames and figures. */
export class LiveSession {
  readonly layer: LiveLayer;
  frames = 0;
  warnings = 0;
  lastLatencyMs: number | null = null;
  private readonly socket: LiveSocket;
  private session: string | null = null;
  private points = 0;
  private done = 0;
  private total = 0;
  private lateFrames = 0;
  private score: number | null = null;
  private scores = { sum: 0, count: 0 };
  private arrivals: number[] = [];
  private readonly mappedAt = new Map<number, number>();
  private readonly undrawn = new Set<number>();

  constructor(url: string, materials: PointMaterials, tileSize: number,
              private readonly trajectory: Trajectory,
              private readonly events: LiveSessionEvents) {
    this.layer = new LiveLayer(materials, tileSize);
    this.socket = new LiveSocket(url, {
      message: (message) => this.take(message),
      odd: () => this.events.odd(++this.warnings),
      opened: () => this.events.connection(true),
      lost: () => this.events.connection(false),
    });
  }

  get connected(): boolean {
    return this.socket.connected;
  }

  get reconnects(): number {
    return this.socket.reconnects;
  }

  stop(): void {
    this.socket.stop();
  }

  /** A picture with all that has come so far is on the screen. */
  drawn(): void {
    const before = this.lastLatencyMs;
    for (const frame of this.undrawn) {
      const mappedAt = this.mappedAt.get(frame);
      this.undrawn.delete(frame);
      if (mappedAt === undefined) continue;  // of a tile, or too long ago
      this.lastLatencyMs = Math.max(0, Date.now() - mappedAt);
      this.mappedAt.delete(frame);
    }
    if (this.lastLatencyMs !== before) this.tell();
  }

  private take(message: LiveMessage): void {
    switch (message.type) {
      case 'hello': return this.hello(message);
      case 'frame': return this.frame(message);
      case 'poses':
        for (const [submap, pose] of message.T_local_submap) {
          this.layer.setSubmapPose(submap, pose);
        }
        for (const [index, pose] of message.T_local_lidar) this.trajectory.movePose(index, pose);
        this.events.framesChanged();
        return this.events.changed();
      case 'points':
        this.layer.take(message);
        this.undrawn.add(message.frame);
        return this.events.changed();
      case 'image': return this.events.image(message.jpeg, message.frame);
      case 'end':
        this.socket.stop();
        return this.events.ended();
    }
  }

  private hello(message: HelloMessage): void {
    // All tiles come again; what has gone meanwhile does not.
    this.layer.clear();
    if (this.session !== null && this.session !== message.session) {
      this.forget();
      this.events.restarted();
    }
    this.session = message.session;
    this.trajectory.clear();
    for (const frame of message.frames) this.trajectory.put(frame);
    message.T_local_submap.forEach((pose, i) => this.layer.setSubmapPose(i, pose));
    this.done = message.done;
    this.total = message.total;
    this.scores = { sum: 0, count: 0 };
    for (const frame of message.frames) this.count(frame);
    this.events.framesChanged();
    this.tell();
    this.events.changed();
  }

  private frame(message: FrameMessage): void {
    const { frame } = message;
    this.trajectory.put(frame);
    ++this.frames;
    this.points = message.points;
    this.done = message.done;
    this.total = message.total;
    this.lateFrames = message.lateFrames;
    this.count(frame);
    this.arrivals = [...this.arrivals.slice(1 - rateFrames), performance.now()];
    if (message.mappedAt !== null) this.mappedAt.set(frame.index, message.mappedAt);
    for (const index of [...this.mappedAt.keys()].slice(0, -100)) this.mappedAt.delete(index);
    this.events.frame(frame);
    this.events.framesChanged();
    this.tell();
    this.events.changed();
  }

  private count({ score }: Frame): void {
    if (score === null) return;
    this.score = score;
    this.scores = { sum: this.scores.sum + score, count: this.scores.count + 1 };
  }

  private forget(): void {
    this.points = this.lateFrames = this.frames = 0;
    this.score = null;
    this.arrivals = [];
    this.mappedAt.clear();
    this.undrawn.clear();
  }

  private tell(): void {
    const { arrivals } = this;
    const seconds = (arrivals.at(-1)! - arrivals[0]!) / 1000;
    this.events.figures({
      done: this.done,
      total: this.total,
      points: this.points || this.layer.points,
      lateFrames: this.lateFrames,
      framesPerSecond: arrivals.length > 1 && seconds > 0 ? (arrivals.length - 1) / seconds : null,
      latencyMs: this.lastLatencyMs,
      score: this.score,
      meanScore: this.scores.count > 0 ? this.scores.sum / this.scores.count : null,
    });
  }
}
