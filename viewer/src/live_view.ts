import { LiveSession } from './live_session';
import { liveUrl } from './live_socket';
import { LiveStrip } from './live_strip';
import type { Notices } from './notices';
import type { PointMaterials } from './point_material';
import type { MapInfo } from './protocol';
import type { Trajectory } from './trajectory';

export interface LiveHost {
  /** There is something new to draw. */
  changed(): void;
  framesChanged(): void;
  /** Another drive is mapped than before. */
  restarted(): void;
  points(count: number): void;
  ended(): void;
}

/** A map that grows, and what is told of it: the strip of figures, and notices. */
export class LiveView {
  readonly session: LiveSession;
  readonly strip: LiveStrip;

  constructor(map: MapInfo, materials: PointMaterials, trajectory: Trajectory, notices: Notices,
              host: LiveHost) {
    const strip = new LiveStrip(1000 * map.sensorPeriod);
    this.strip = strip;
    this.session = new LiveSession(liveUrl(location.href), materials, map.tileSize, trajectory, {
      changed: () => host.changed(),
      framesChanged: () => host.framesChanged(),
      frame: (frame) => strip.addFrame(frame),
      image: (jpeg) => strip.setImage(jpeg),
      figures: (figures) => {
        strip.show(figures);
        host.points(figures.points);
      },
      restarted: () => {
        strip.clear();
        host.restarted();
      },
      connection: (connected) => {
        if (connected) return notices.clear('live');
        notices.show('live', {
          text: 'The server is away. The map stays; what is missed comes when it is back.',
        });
      },
      odd: (count) => notices.show('odd', {
        text: `${count} ${count === 1 ? 'message' : 'messages'} of the server made no sense ` +
          'and were left out.',
      }),
      ended: () => host.ended(),
    });
  }

  /** The finished map has taken over. */
  clear(): void {
    this.session.stop();
    this.session.layer.clear();
    this.strip.element.remove();
  }
}
