import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { run, runQuietly } from '../../scripts/run-command.mjs';
import { directoryWith } from '../temporary-directory';

const node = (script: string, options = {}) => run(process.execPath, ['-e', script], { capture: true, ...options });

function isAlive(pid: number): boolean {
  try {
    return process.kill(pid, 0);
  } catch (error) {
    if ((error as NodeJS.ErrnoException).code === 'ESRCH') return false;
    throw error;
  }
}

describe('a program that is run', () => {
  test('tells its exit code and its output', async () => {
    const result = await node("console.log('out'); console.error('err'); process.exit(3)");
    expect(result).toMatchObject({ code: 3, timedOut: false });
    expect(result.output).toContain('out\n');
    expect(result.output).toContain('err\n');
  });

  test('finds its standard input closed: nothing it asks can wait for an answer', async () => {
    expect((await node("process.stdin.on('end', () => process.exit(7)).resume()")).code).toBe(7);
  });

  test.skipIf(process.platform === 'win32')('is ended with everything it started when it runs too long', async () => {
    const directory = directoryWith();
    const pidFile = join(directory, 'pid');
    const forever = 'setInterval(() => {}, 1000)';
    const script = `
      const child = require('node:child_process').spawn(process.execPath, ['-e', ${JSON.stringify(forever)}]);
      require('node:fs').writeFileSync(${JSON.stringify(pidFile)}, String(child.pid));
      ${forever}`;
    const result = await node(script, { limitSeconds: 1 });
    expect(result).toMatchObject({ timedOut: true });
    expect(result.code).not.toBe(0);
    expect(existsSync(pidFile)).toBe(true);
    await expect.poll(() => isAlive(Number(readFileSync(pidFile, 'utf8')))).toBe(false);
  });

  test('that is not installed: null when asked quietly, an error otherwise', async () => {
    expect(await runQuietly('no-such-program-here', [])).toBeNull();
    await expect(run('no-such-program-here', [])).rejects.toThrow(/ENOENT/);
  });
});
