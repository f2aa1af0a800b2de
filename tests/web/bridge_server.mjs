// A Foxglove bridge that plays a recording, by the server of the protocol's authors.
import { once } from 'node:events';

import protocol from '@foxglove/ws-protocol';
import { WebSocketServer } from 'ws';

import { topicsOf } from './bags.mjs';
import { ros1SchemaOf, schemaOf } from './ros_messages.mjs';

export class BridgeServer {
  /// @param messages  of record()
  /// @param takesPoses  clients may publish, as JSON
  static async start(messages, { ros1 = false, takesPoses = false } = {}) {
    const server = new BridgeServer(messages, ros1, takesPoses);
    await once(server.web, 'listening');
    return server;
  }

  constructor(messages, ros1, takesPoses) {
    this.messages = messages;
    this.server = new protocol.FoxgloveServer({ name: 'fovea tests',
      capabilities: takesPoses ? ['clientPublish'] : [], supportedEncodings: takesPoses ? ['json'] : undefined });
    this.subscribed = new Set();
    this.channels = new Map();
    this.ros1 = ros1;
    for (const topic of topicsOf(messages)) this.channels.set(topic.name, this.offer(topic));
    this.server.on('subscribe', (channel) => this.subscribed.add(channel));
    this.server.on('unsubscribe', (channel) => this.subscribed.delete(channel));
    this.needed = new Set(this.channels.keys());
    this.web = new WebSocketServer({ port: 0, host: '127.0.0.1',
      handleProtocols: (protocols) => this.server.handleProtocols(protocols) });
    this.web.on('connection', (connection) => {
      this.connection = connection;
      this.server.handleConnection(connection, 'client');
    });
  }

  /// Advertises a channel, and returns its number.
  offer({ name, type }) {
    const { ros1 } = this;
    return this.server.addChannel({
      topic: name, encoding: ros1 ? 'ros1' : 'cdr', schemaName: type,
      schema: ros1 ? ros1SchemaOf(type) : schemaOf(type), schemaEncoding: ros1 ? 'ros1msg' : 'ros2msg' });
  }

  get url() {
    return `ws://127.0.0.1:${this.web.address().port}`;
  }

  /// Until the client has subscribed to all topics, or to those that are `needed`.
  async subscribedToAll() {
    const isReady = () => [...this.needed].every((topic) => this.subscribed.has(this.channels.get(topic)));
    while (!isReady()) await new Promise((done) => setTimeout(done, 5));
  }

  /// Sends some of the messages, and waits until the client has read them: it answers a ping after them.
  async play(begin = 0, end = this.messages.length) {
    await this.subscribedToAll();
    for (const { topic, time, data } of this.messages.slice(begin, end)) {
      this.server.sendMessage(this.channels.get(topic), time, data);
    }
    this.connection.ping();
    await once(this.connection, 'pong');
  }

  /// Cuts the connection as a network does.
  async cut() {
    const gone = once(this.connection, 'close');
    this.connection.terminate();
    await gone;
    while (this.subscribed.size > 0) await new Promise((done) => setTimeout(done, 5));
  }

  close() {
    this.connection?.close();
    this.web.close();
  }
}
