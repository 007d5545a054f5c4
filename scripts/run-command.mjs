import { spawn, spawnSync } from 'node:child_process';
import { resolve as resolvePath } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

/** The root of the repository, without a trailing slash. */
export const root = fileURLToPath(new URL('..', import.meta.url)).replace(/[\\/]$/, '');

/** Resolves a path relative to the folder in which the npm command was typed. */
export const typedPath = (path) => resolvePath(process.env.INIT_CWD ?? process.cwd(), path);

/** An error whose message is shown without a stack. */
export class SetupError extends Error {}

/**
 * The running child processes. Each leads its own process group, or tree on Windows, so that none outlives the script
 * that started it.
 */
const running = new Set();

function killGroup(child, signal) {
  try {
    if (process.platform === 'win32') spawnSync('taskkill', ['/pid', String(child.pid), '/T', '/F']);
    else process.kill(-child.pid, signal);
  } catch (error) {
    if (error.code !== 'ESRCH') throw error;
  }
}

const exitCodes = { SIGINT: 130, SIGTERM: 143, SIGHUP: 129 };

function endWithChildren(signal) {
  for (const child of running) killGroup(child, 'SIGTERM');
  process.exit(exitCodes[signal]);
}

/** Registers the signal handlers only while children run: a server in this process handles signals itself. */
function watchSignals() {
  for (const signal of Object.keys(exitCodes)) {
    process.off(signal, endWithChildren);
    if (running.size > 0) process.on(signal, endWithChildren);
  }
}

/**
 * Runs a program in the repository's root with its standard input closed, until `signal` aborts. Resolves to its exit
 * code and its output (with `capture`). Rejects only if the program does not exist.
 */
export function run(command, args, { env = {}, cwd = root, capture = false, signal } = {}) {
  return new Promise((resolve, reject) => {
    const child = spawn(command, args, {
      cwd,
      env: { ...process.env, ...env },
      stdio: ['ignore', capture ? 'pipe' : 'inherit', capture ? 'pipe' : 'inherit'],
      detached: process.platform !== 'win32',
      shell: process.platform === 'win32' && /^(npm|npx)$/.test(command),
    });
    running.add(child);
    watchSignals();
    let output = '';
    for (const stream of [child.stdout, child.stderr]) {
      stream?.setEncoding('utf8').on('data', (text) => {
        output += text;
      });
    }
    const end = () => killGroup(child, 'SIGTERM');
    signal?.addEventListener('abort', end);
    const settle = (action) => {
      signal?.removeEventListener('abort', end);
      running.delete(child);
      watchSignals();
      action();
    };
    child.once('error', (error) => settle(() => reject(error)));
    child.once('close', (code) => settle(() => resolve({ code: code ?? 1, output })));
  });
}

/** Runs a TypeScript program of the repository; resolves to its exit code. */
export async function runProgram(program, args) {
  const { code } = await run(process.execPath, ['--import', 'tsx', program, ...args]);
  return code;
}

/** Like `run` with captured output; resolves to null if the program is not installed. */
export async function runQuietly(command, args, options = {}) {
  try {
    return await run(command, args, { ...options, capture: true });
  } catch (error) {
    if (error.code === 'ENOENT' || error.code === 'EACCES') return null;
    throw error;
  }
}

/** Resolves to the output of a program; rejects with a SetupError of this fault and the output if it fails. */
export async function outputOf(command, args, fault, options) {
  const result = await runQuietly(command, args, options);
  if (result?.code !== 0) throw new SetupError(`${fault}:\n${result?.output.trim() ?? `${command} is not there`}`);
  return result.output;
}

/** Installs packages of Debian or Ubuntu, as root on such a system only. Resolves to whether it could. */
export async function installWithApt(...packages) {
  if (process.getuid?.() !== 0 || (await runQuietly('apt-get', ['--version'])) === null) return false;
  const env = { DEBIAN_FRONTEND: 'noninteractive' };
  console.log(`Installing ${packages.join(' and ')} ...`);
  await run('apt-get', ['update', '-qq'], { env });
  await run('apt-get', ['install', '-y', '-qq', '--no-install-recommends', ...packages], { env });
  return true;
}

/** Ends this process when its parent shell has ended: npm passes signals only to that shell. */
function stopWithParent() {
  const parent = process.ppid;
  setInterval(() => {
    if (process.ppid !== parent) process.kill(process.pid, 'SIGTERM');
  }, 500).unref();
}

/** Runs a script's body; prints the message of a SetupError and exits with code 1. */
export async function main(body) {
  if (process.env.npm_lifecycle_event) stopWithParent();
  try {
    process.exitCode = (await body()) ?? 0;
  } catch (error) {
    if (!(error instanceof SetupError)) throw error;
    console.error(`\n${error.message}`);
    process.exitCode = 1;
  }
}

/** Runs the body like `main`, if the script with this `import.meta.url` is the program and no module of another one. */
export const mainOf = (url, body) => (url === pathToFileURL(process.argv[1] ?? '').href ? main(body) : null);
