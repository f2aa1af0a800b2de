// What mapping a running robot costs: a drive played in real time through the bridge's protocol, next to the same drive
// from files at that rate.
//
//   FOVEA_PROGRAM=fovea node live_bench.mjs DRIVE [RATE_HZ]
//
// DRIVE is a folder with a drive.toml and poses.csv or gnss.csv, recorded at 10 Hz. Prints JSON: frames, skipped
// textures, latency (ms), memory in each quarter of the run (MB), and of `fovea evaluate` if the drive has its truth.
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { record } from './bags.mjs';
import { BridgeServer } from './bridge_server.mjs';
import { readDrive } from './drive_folder.mjs';
import { programNamedBy } from './test_map.mjs';

const program = programNamedBy('FOVEA_PROGRAM');
const [folder, rateText = '10'] = process.argv.slice(2);
const rate = Number(rateText);
const work = mkdtempSync(join(tmpdir(), 'fovea_live_bench_'));

const sleepUntil = (time) => new Promise((done) => setTimeout(done, Math.max(0, time - performance.now())));
const reportOf = (name) => JSON.parse(readFileSync(join(work, name), 'utf8'));

/// Resident memory of a process, MB.
function memoryOf(pid) {
  const line = /^VmRSS:\s+(\d+) kB$/m.exec(readFileSync(`/proc/${pid}/status`, 'utf8'));
  return line ? Number(line[1]) / 1024 : 0;
}

/// Sends each message at its time, as a robot does: it does not wait for the client.
async function playInTime(server, messages, sample) {
  const factor = 10 / rate / 1e6;
  const begin = performance.now(), first = messages[0].time;
  for (const { topic, time, data } of messages) {
    await sleepUntil(begin + Number(time - first) * factor);
    server.server.sendMessage(server.channels.get(topic), time, data);
    sample();
  }
}

/// The largest memory in each quarter.
function quarters(samples) {
  const size = Math.ceil(samples.length / 4);
  return [0, 1, 2, 3].map((i) => Math.round(Math.max(...samples.slice(i * size, (i + 1) * size))));
}

async function mapLive(messages) {
  const server = await BridgeServer.start(messages);
  const child = spawn(program, ['map', server.url, '-o', join(work, 'live.fovea'), '--report', join(work, 'live.json'),
    '--hold-out', '8:4', '--quiet'], { stdio: ['ignore', 'inherit', 'inherit'] });
  const ended = once(child, 'close');
  await server.subscribedToAll();
  const memory = [];
  await playInTime(server, messages, () => memory.push(memoryOf(child.pid)));
  server.close();
  const [status] = await ended;
  if (status !== 0) throw new Error(`fovea map has failed: ${status}`);
  return quarters(memory);
}

/// Scores of the held-out frames, and against the truth if the drive has it.
function evaluate(name) {
  const protocols = existsSync(join(folder, 'truth')) ? ['held-out', 'truth'] : ['held-out'];
  return Object.fromEntries(protocols.map((protocol) => {
    const report = `${name}_${protocol}.json`;
    execFileSync(program, ['evaluate', join(work, `${name}.fovea`), folder, '--protocol', protocol, '--foreign',
      '--json', join(work, report)], { stdio: ['ignore', 'ignore', 'inherit'] });
    const { frames, warnings, ...scores } = reportOf(report);
    return [protocol, scores];
  }));
}

function figuresOf(name) {
  const { map, live } = reportOf(`${name}.json`);
  return { frames: map.frames, textures_skipped: map.textures_skipped, frames_skipped: map.frames_skipped,
    late_frames: map.late_frames, latency_ms: map.latency_ms.frame, wait_ms: map.latency_ms.wait,
    peak_rss_mb: Math.round(map.peak_rss_mb), points: map.points, live, ...evaluate(name) };
}

try {
  const messages = record(readDrive(folder), { images: 'rgb8', poses: existsSync(join(folder, 'poses.csv'))
    ? 'odometry' : 'gnss' });
  const memory_mb = await mapLive(messages);
  execFileSync(program, ['map', folder, '-o', join(work, 'file.fovea'), '--rate', String(rate), '--hold-out', '8:4', '--quiet',
    '--report', join(work, 'file.json')], { stdio: ['ignore', 'inherit', 'inherit'] });
  console.log(JSON.stringify({ rate_hz: rate, live: { memory_mb, ...figuresOf('live') }, file: figuresOf('file') }, null, 2));
} finally {
  if (process.env.FOVEA_KEEP) console.error(work);
  else rmSync(work, { recursive: true, force: true });
}
