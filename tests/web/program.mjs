// The program in the background.
import { spawn } from 'node:child_process';
import { once } from 'node:events';

import { programNamedBy } from './test_map.mjs';

/// `fovea ARGUMENTS...`, as the process, a promise of {status, out, err} and a wait for words that it prints.
/// @param largestFile  KiB: writes beyond fail, as on a full disk
export function startProgram(args, { largestFile = null } = {}) {
  const program = programNamedBy('FOVEA_PROGRAM');
  const child = largestFile === null ? spawn(program, args)
    : spawn('bash', ['-c', `ulimit -f ${largestFile}; exec "$0" "$@"`, program, ...args]);
  const said = { out: '', err: '' };
  child.stdout.on('data', (bytes) => { said.out += bytes; });
  child.stderr.on('data', (bytes) => { said.err += bytes; });
  const ended = once(child, 'close').then(([status]) => ({ status, ...said }));
  const saying = async (pattern, where = 'err') => {
    while (!pattern.test(said[where])) await once(where === 'err' ? child.stderr : child.stdout, 'data');
    return pattern.exec(said[where]);
  };
  return { child, ended, saying };
}
