// Writes bags of ROS 1, by rosbag itself (Debian's python3-rosbag).
import { execFileSync } from 'node:child_process';
import { join } from 'node:path';

/// @param messages  of record({ ros1: true })
/// @param compression  "none", "bz2" or "lz4"
export function writeRos1Bag(path, messages, { compression = 'none' } = {}) {
  const lines = messages.map(({ topic, type, time, data }) => JSON.stringify(
    { topic, type, time: String(time), data: Buffer.from(data.buffer, data.byteOffset, data.byteLength).toString('base64') }));
  execFileSync('/usr/bin/python3', [join(import.meta.dirname, 'write_ros1_bag.py'), path, compression],
    { input: lines.join('\n') });
}

/// The records of a bag: {operation, begin, data, size}, places in bytes.
export function ros1BagRecords(bytes) {
  const records = [];
  for (let begin = '#ROSBAG V2.0\n'.length; begin + 4 <= bytes.length;) {
    const header = bytes.readUInt32LE(begin), data = begin + 4 + header + 4;
    const size = bytes.readUInt32LE(data - 4);
    const operation = bytes[bytes.indexOf('op=', begin) + 'op='.length];
    records.push({ operation, begin, data, size });
    begin = data + size;
  }
  return records;
}
