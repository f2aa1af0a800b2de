// Writes the folders that `ros2 bag record` of Humble writes with its sqlite3 storage, by SQLite itself.
import { mkdirSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';

import zstd from '@foxglove/wasm-zstd';
import initSqlJs from 'sql.js';

import { topicsOf } from './bags.mjs';

const sql = await initSqlJs();
await zstd.isLoaded;

const tables = `
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
                      data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
INSERT INTO schema VALUES (3, 'humble');`;

/// The bytes of a database.
function database(topics, messages) {
  const db = new sql.Database();
  db.run('BEGIN');
  db.run(tables);
  const ids = new Map();
  topics.forEach(({ name, type, qos }, i) => {
    db.run('INSERT INTO topics VALUES (?, ?, ?, ?, ?)', [i + 1, name, type, 'cdr', qos]);
    ids.set(name, i + 1);
  });
  const insert = db.prepare('INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)');
  for (const { topic, time, data } of messages) insert.run([ids.get(topic), time, data]);
  insert.free();
  db.run('COMMIT');
  const bytes = db.export();
  db.close();
  return bytes;
}

/// When messages were recorded, in lines of metadata.yaml.
function extent(messages, indent) {
  const [first, last] = [messages[0].time, messages.at(-1).time];
  return ['duration:', `  nanoseconds: ${last - first}`, 'starting_time:', `  nanoseconds_since_epoch: ${first}`,
    `message_count: ${messages.length}`].map((line) => `${indent}${line}\n`).join('');
}

/// As Humble has it, a compressed file stands with its ending in the first list and without it in the second.
function metadata(topics, parts, compression) {
  const all = parts.flatMap(({ messages }) => messages);
  const topicText = ({ name, type, qos }) =>
    `    - topic_metadata:\n        name: ${name}\n        type: ${type}\n`
    + `        serialization_format: cdr\n        offered_qos_profiles: ${JSON.stringify(qos)}\n`
    + `      message_count: ${all.filter(({ topic }) => topic === name).length}\n`;
  const fileText = ({ file, messages }) =>
    `    - path: ${file.replace('.zstd', '')}\n${extent(messages, '      ')}`;
  return `rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n${extent(all, '  ')}`
    + `  topics_with_message_count:\n${topics.map(topicText).join('')}`
    + `  compression_format: ${compression ? 'zstd' : '""'}\n  compression_mode: ${compression || '""'}\n`
    + `  relative_file_paths:\n${parts.map(({ file }) => `    - ${file}\n`).join('')}`
    + `  files:\n${parts.map(fileText).join('')}`;
}

/// @param files  how many the messages are split into
/// @param compression  "", "MESSAGE" or "FILE", as metadata.yaml has it: of zstd
export function writeRosbag2(folder, messages, { files = 1, compression = '' } = {}) {
  mkdirSync(folder);
  const topics = topicsOf(messages), share = Math.ceil(messages.length / files);
  const parts = Array.from({ length: files }, (_, i) => ({
    file: `${basename(folder)}_${i}.db3${compression === 'FILE' ? '.zstd' : ''}`,
    messages: messages.slice(i * share, (i + 1) * share),
  }));
  for (const part of parts) {
    const stored = compression !== 'MESSAGE' ? part.messages
      : part.messages.map((message) => ({ ...message, data: zstd.compress(message.data, 1) }));
    const bytes = database(topics, stored);
    writeFileSync(join(folder, part.file), compression === 'FILE' ? zstd.compress(bytes, 1) : bytes);
  }
  writeFileSync(join(folder, 'metadata.yaml'), metadata(topics, parts, compression));
}
