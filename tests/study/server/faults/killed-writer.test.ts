import { spawn } from 'node:child_process';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { DatabaseSync } from '@photostructure/sqlite';
import { describe, expect, test } from 'vitest';
import { completed } from '../../model/studies';
import { now } from '../running-studies';
import { opened, withPaperStudy } from '../stored-studies';

const root = fileURLToPath(new URL('../../../..', import.meta.url));

describe('a server killed while it writes (kill -9)', () => {
  /** Lets the writer live for some acknowledgements and then kills it; what it acknowledged. */
  const acknowledgedBefore = (file: string, first: number, acknowledgements: number) =>
    new Promise<string[]>((resolve, reject) => {
      const writer = spawn(
        process.execPath,
        ['--import', 'tsx', join(root, 'tests/study/server/faults/study-writer.ts'), file, String(first)],
        { cwd: root, stdio: ['ignore', 'pipe', 'pipe'] },
      );
      let said = '';
      let complaint = '';
      writer.stderr.on('data', (chunk) => {
        complaint += chunk;
      });
      writer.stdout.on('data', (chunk) => {
        said += chunk;
        if (said.split('\n').length > acknowledgements) writer.kill('SIGKILL');
      });
      writer.on('close', (_, signal) => {
        if (signal !== 'SIGKILL') reject(new Error(`the writer ended by itself: ${complaint}`));
        // The last line may be cut off.
        else resolve(said.split('\n').slice(0, -1));
      });
    });

  test('loses nothing that was acknowledged, and no half of a batch remains', { tags: ['full'] }, async () => {
    const { store, file } = withPaperStudy();
    store.records.store('paper', 'P01', completed().slice(0, 1), now);
    store.close();
    const acknowledged: string[] = [];
    for (const [round, count] of [1, 7, 40, 150].entries()) {
      acknowledged.push(...(await acknowledgedBefore(file, 1_000_000 * (round + 1), count)));
      const { store: survivor } = opened(file);
      const stored = new Set(survivor.records.all('paper', 'P01').map(({ id }) => id));
      for (const id of acknowledged) expect(stored.has(id), id).toBe(true);
      const firstHalves = [...stored].filter((id) => id.endsWith('-a'));
      expect(firstHalves.length).toBeGreaterThan(0);
      for (const id of firstHalves) expect(stored.has(id.replace(/a$/, 'b')), id).toBe(true);
      survivor.close();
      const database = new DatabaseSync(file);
      expect(database.prepare('PRAGMA integrity_check').get()).toMatchObject({ integrity_check: 'ok' });
      database.close();
    }
    expect(acknowledged.length).toBeGreaterThanOrEqual(1 + 7 + 40 + 150);
  });
});
