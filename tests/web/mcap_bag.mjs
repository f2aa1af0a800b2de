// Writes MCAP files, by the library of the format's authors.
import { writeFileSync } from 'node:fs';

import zstd from '@foxglove/wasm-zstd';
import { McapWriter } from '@mcap/core';
import lz4 from 'lz4js';

import { topicsOf } from './bags.mjs';
import { schemaOf } from './ros_messages.mjs';

await zstd.isLoaded;

class Bytes {
  parts = [];
  size = 0;

  async write(part) {
    this.parts.push(Uint8Array.from(part));  // the writer goes on with its buffer
    this.size += part.length;
  }

  position() {
    return BigInt(this.size);
  }
}

const compressors = {
  none: (data) => data,
  zstd: (data) => zstd.compress(data, 3),
  lz4: (data) => lz4.compress(data),
};

/// @param compression  "none", "zstd", "lz4"; any other name is written with the chunks as they are
/// @param chunks  false: the messages stand in the file themselves
/// @param schema  of a type: {encoding, data}
export async function writeMcap(path, messages, { compression = 'zstd', chunks = true, profile = 'ros2',
  messageEncoding = 'cdr', schema = (type) => ({ encoding: 'ros2msg', data: schemaOf(type) }) } = {}) {
  const writable = new Bytes();
  const compress = compressors[compression] ?? compressors.none;
  const writer = new McapWriter({ writable, useChunks: chunks, compressChunk: compression === 'none' ? undefined
    : (data) => ({ compression, compressedData: compress(data) }) });
  await writer.start({ profile, library: 'fovea tests' });
  const channels = new Map();
  for (const { name, type, qos } of topicsOf(messages)) {
    const { encoding, data } = schema(type);
    const schemaId = await writer.registerSchema({ name: type, encoding, data: Buffer.from(data) });
    channels.set(name, await writer.registerChannel({ schemaId, topic: name, messageEncoding,
      metadata: new Map([['offered_qos_profiles', qos]]) }));
  }
  for (const [sequence, { topic, time, data }] of messages.entries()) {
    const channelId = channels.get(topic);
    await writer.addMessage({ channelId, sequence, logTime: time, publishTime: time, data });
  }
  await writer.addMetadata({ name: 'rosbag2', metadata: new Map([['ros_distro', 'humble']]) });
  await writer.end();
  writeFileSync(path, Buffer.concat(writable.parts));
}

/// The records of a file: {opcode, begin, end} in bytes, opcode and length included.
export function recordsOf(bytes) {
  const magic = 8, records = [];
  for (let begin = magic; begin + 9 <= bytes.length - magic;) {
    const end = begin + 9 + Number(bytes.readBigUInt64LE(begin + 1));
    records.push({ opcode: bytes[begin], begin, end });
    begin = end;
  }
  return records;
}

export const opcodes = { header: 1, footer: 2, schema: 3, channel: 4, message: 5, chunk: 6, dataEnd: 15 };
