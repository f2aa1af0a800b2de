import { parseBinary, parseText, type LiveMessage } from './live_message';

export interface LiveSocketEvents {
  message(message: LiveMessage): void;
  /** A message made no sense and was left out. */
  odd(): void;
  opened(): void;
  lost(): void;
}

const shortestWait = 250;
const longestWait = 5000;
/** A connection that ends sooner counts as none: what ends it may be what it asks for. */
const lasting = 5000;

/** The connection to a map that grows; comes back by itself until told to stop. */
export class LiveSocket {
  connected = false;
  reconnects = 0;
  private socket: WebSocket | null = null;
  private wait = shortestWait;
  private timer = 0;
  private openedAt = 0;
  private stopped = false;
  private everOpened = false;

  constructor(private readonly url: string, private readonly events: LiveSocketEvents) {
    this.open();
  }

  stop(): void {
    this.stopped = true;
    clearTimeout(this.timer);
    this.socket?.close();
    this.connected = false;
  }

  private open(): void {
    const socket = new WebSocket(this.url);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => {
      if (this.everOpened) ++this.reconnects;
      this.everOpened = true;
      this.connected = true;
      this.openedAt = performance.now();
      this.events.opened();
    };
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (this.stopped) return;
      const message = typeof data === 'string' ? parseText(data) : parseBinary(data);
      if (message) this.events.message(message);
      else this.events.odd();
    };
    socket.onclose = () => {
      if (this.connected && performance.now() - this.openedAt > lasting) this.wait = shortestWait;
      this.connected = false;
      if (this.stopped) return;
      this.events.lost();
      this.timer = window.setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(longestWait, 2 * this.wait);
    };
  }
}

/** Relative to the page's own address, by ws or wss. */
export function liveUrl(page: string): string {
  const url = new URL('live', page);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  url.hash = '';
  url.search = '';
  return url.href;
}
