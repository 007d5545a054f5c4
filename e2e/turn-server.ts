import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { readFileSync } from 'node:fs';
import { setTimeout } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { parse } from 'yaml';
import { installed } from '../tests/server/installed';
import { freePort } from './free-port';

export const turnProgram = installed('turnserver');
export const turnSecret = 'turn-kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';

/** Returns the arguments of coturn in deploy/compose.yaml, as its shell would parse them. */
function composeArguments(): readonly string[] {
  const file = fileURLToPath(new URL('../deploy/compose.yaml', import.meta.url));
  const { services } = parse(readFileSync(file, 'utf8'), { merge: true }) as {
    readonly services: { readonly turn: { readonly command: readonly string[] } };
  };
  const [command = ''] = services.turn.command;
  const begin = command.indexOf('turnserver ');
  if (begin < 0) throw new Error(`compose.yaml: the service turn does not start turnserver: ${command}`);
  const words = command.slice(begin).trim().split(/\s+/).slice(1);
  return words.map((word) => word.replace('"$$SECRET"', turnSecret));
}

/** Starts coturn as deploy/compose.yaml does, on loopback and a free port. */
export async function startTurn() {
  const port = await freePort();
  const here = [
    `--listening-port=${port}`,
    '--listening-ip=127.0.0.1',
    '--relay-ip=127.0.0.1',
    '--no-tls',
    '--no-dtls',
    // The deployment denies peers on the relay's own machine; in this test both peers are on it.
    ...['--allow-loopback-peers', '--no-cli'],
  ];
  const child = spawn(turnProgram ?? 'turnserver', [...composeArguments(), ...here], {
    stdio: ['ignore', 'pipe', 'pipe'],
  });
  let said = '';
  const hear = (text: string) => {
    said += text;
  };
  child.stdout.setEncoding('utf8').on('data', hear);
  child.stderr.setEncoding('utf8').on('data', hear);
  while (!said.includes('auth thread')) {
    if (child.exitCode !== null) throw new Error(`coturn ended: ${said}`);
    await setTimeout(50);
  }
  return {
    url: `turn:127.0.0.1:${port}?transport=udp`,
    async close() {
      if (child.exitCode !== null) return;
      const gone = once(child, 'exit');
      child.kill('SIGKILL');
      await gone;
    },
  };
}
