// What mapping a running robot costs: a drive played in real time through the bridge's protocol, next to the same drive
// from files at that rate.
//
//   FOVEA_PROGRAM=fovea node live_bench.mjs DRIVE [RATE_HZ]
//
// DRIVE is a folder with a drive.toml and poses.csv or gnss.csv, recorded at 10 Hz. Prints JSON: frames, skipped
// textures, latency (ms), memory in each quarter of the run (MB), and of `fovea evaluate` if the drive has its truth.
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync }
  from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

import { record } from './bags.mjs';
import { BridgeServer } from './bridge_server.mjs';
import { readDrive, readTable } from './drive_folder.mjs';
import { programNamedBy } from './test_map.mjs';

const program = programNamedBy('FOVEA_PROGRAM');
const [folderText, rateText = '10'] = process.argv.slice(2);
const folder = resolve(folderText);
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

/// Numbers of the scans that are frames of a map, in their order.
function acceptedScans(name) {
  const table = join(work, `${name}.csv`);
  execFileSync(program, ['export', join(work, `${name}.fovea`), table, '--format', 'frames']);
  const stamps = readTable(join(folder, 'lidar', 'stamps.csv'));
  const numbers = new Map(stamps.map(({ index, time }) => [time, Number(index)]));
  return readTable(table).map(({ time }) => numbers.get(time));
}

/// Links the files of accepted scans and of their images, by the numbers of their frames.
function linkAccepted(from, to, accepted) {
  const keep = (lines) => accepted.map((number) => lines[number]);
  mkdirSync(to);
  for (const entry of readdirSync(from, { withFileTypes: true })) {
    const source = join(from, entry.name), target = join(to, entry.name);
    const [, number, ending] = /^(\d+)(\.\w+)$/.exec(entry.name) ?? [];
    if (entry.isDirectory()) {
      linkAccepted(source, target, accepted);
    } else if (number) {
      const frame = accepted.indexOf(Number(number));
      if (frame >= 0) symlinkSync(source, join(to, String(frame).padStart(number.length, '0') + ending));
    } else if (entry.name === 'stamps.csv') {
      const [header, ...rows] = readFileSync(source, 'utf8').split('\n');
      const kept = keep(rows).map((row, frame) => row.replace(/^\d+/, frame));
      writeFileSync(target, `${[header, ...kept].join('\n')}\n`);
    } else if (entry.name.endsWith('.txt')) {
      writeFileSync(target, `${keep(readFileSync(source, 'utf8').split('\n')).join('\n')}\n`);
    } else if (entry.name === 'truth.json') {
      const truth = JSON.parse(readFileSync(source, 'utf8'));
      writeFileSync(target, JSON.stringify({ ...truth, frames: accepted.length }));
    } else if (!entry.name.startsWith('tracklet')) {  // which have numbers inside
      symlinkSync(source, target);
    }
  }
}

/// The drive of the frames of a map: `evaluate` pairs frames by their numbers, which differ after a dropped scan. Its
/// images are numbered as its scans, as the simulator does.
function driveOf(name) {
  const accepted = acceptedScans(name);
  if (accepted.every((number, frame) => number === frame)) return folder;
  const drive = join(work, `${name}_drive`);
  linkAccepted(folder, drive, accepted);
  return drive;
}

/// Scores of the held-out frames, and against the truth if the drive has it.
function evaluate(name) {
  const drive = driveOf(name);
  const protocols = existsSync(join(folder, 'truth')) ? ['held-out', 'truth'] : ['held-out'];
  return Object.fromEntries(protocols.map((protocol) => {
    const report = `${name}_${protocol}.json`;
    execFileSync(program, ['evaluate', join(work, `${name}.fovea`), drive, '--protocol', protocol, '--foreign',
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
  execFileSync(program, ['map', folder, '-o', join(work, 'file.fovea'), '--rate', String(rate), '--hold-out', '8:4',
    '--quiet', '--report', join(work, 'file.json')], { stdio: ['ignore', 'inherit', 'inherit'] });
  const live = { memory_mb, ...figuresOf('live') };
  console.log(JSON.stringify({ rate_hz: rate, live, file: figuresOf('file') }, null, 2));
} finally {
  if (process.env.FOVEA_KEEP) console.error(work);
  else rmSync(work, { recursive: true, force: true });
}
