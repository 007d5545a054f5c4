import { spawnSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { expect, test } from 'vitest';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const power = (...args: readonly string[]) =>
  spawnSync(process.execPath, ['scripts/tool.mjs', 'study:power', ...args], { cwd: root, encoding: 'utf8' });

test('npm run tool -- study:power gives the participants a study needs, or the question’s fault', {
  tags: ['full'],
}, () => {
  const { stdout, status } = power('--effect', '1', '--studies', '2000');
  expect(stdout).toContain('Paired, d_z = 1, two-sided α = 0.05: 2000 simulated studies a row, normal values, seed 1.');
  expect(stdout).toMatch(/For a power of 0.8: (10|11) participants by the t-test/);
  expect(status).toBe(0);
  const wrong = power('--effect', 'large');
  expect(wrong.stderr).toContain('study:power: --effect: expected a number from 0 to 10');
  expect(wrong.status).toBe(1);
  expect(power().stderr).toContain('--effect: is missing');
  expect(power('--effect', '0').stderr).toContain('--effect: expected at least 0.05');
});

test('study:power --margin counts participants for equivalence, between conditions and beyond the effect', {
  tags: ['full'],
}, () => {
  const { stdout } = power('--effect', '0', '--margin', '1', '--studies', '2000');
  expect(stdout).toContain('two one-sided tests of equivalence within ±1, α = 0.05: 2000 simulated studies');
  // The normal approximation, (1.645 + 1.282)² = 8.6, and some for t.
  expect(stdout).toMatch(/For a power of 0.8: (10|11) participants by the t-test\.\n/);
  expect(power('--effect', '1', '--margin', '1').stderr).toContain('--effect: expected less than the margin, 1');
  const between = power('--effect', '0', '--margin', '1', '--design', 'between');
  expect(between.stderr).toContain('--margin: equivalence is tested between conditions');
});
