import { type ChildProcess, execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { expect } from '@playwright/test';
import { installed } from '../tests/server/installed';

const program = installed('pulseaudio');
const control = installed('pactl');
export const loudspeakerInstalled = program !== null && control !== null;

/**
 * A virtual loudspeaker whose output is the microphone's input: at the same level, delayed by both buffers, without
 * reverberation.
 */
export interface Loudspeaker {
  /** The environment of a process that uses this loudspeaker and microphone. */
  readonly environment: Readonly<Record<string, string>>;
  close(): Promise<void>;
}

/** Starts a PulseAudio for this test alone, with a null sink and a source that records the sink's output. */
export async function startLoudspeaker(): Promise<Loudspeaker> {
  const folder = mkdtempSync(join(tmpdir(), 'threepoint-sound-'));
  const socket = join(folder, 'socket');
  const own = { ...process.env, HOME: folder, XDG_RUNTIME_DIR: folder } as Record<string, string>;
  const modules = [
    'module-null-sink sink_name=loudspeaker rate=48000',
    // Chromium does not offer a monitor as a microphone, but it offers a source remapped from one.
    'module-remap-source master=loudspeaker.monitor source_name=microphone',
    `module-native-protocol-unix socket=${socket} auth-anonymous=1`,
  ];
  const settings = ['-n', '--daemonize=no', '--exit-idle-time=-1', '--use-pid-file=no', '--disable-shm'];
  const child: ChildProcess = spawn(program ?? 'pulseaudio', [...settings, ...modules.map((one) => `--load=${one}`)], {
    env: own,
    stdio: 'ignore',
  });
  const environment = { ...own, PULSE_SERVER: `unix:${socket}` };
  await expect.poll(() => existsSync(socket)).toBe(true);
  execFileSync(control ?? 'pactl', ['set-default-source', 'microphone'], { env: environment });
  return {
    environment,
    async close() {
      const gone = once(child, 'exit');
      child.kill('SIGTERM');
      await gone;
      rmSync(folder, { recursive: true });
    },
  };
}
