import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { expect, test } from 'vitest';
import { root } from '../../scripts/run-command.mjs';

test.each([
  [[], '--mocap is needed'],
  [['--mocap', 'DIR', '--epochs', '1'], "Unknown option '--epochs'"],
])('the paper’s tool called with %j says what is wrong and how it is used', (args, message) => {
  const { stderr, status } = spawnSync(process.execPath, [join(root, 'scripts/tool.mjs'), 'paper', ...args], {
    encoding: 'utf8',
  });
  expect(stderr).toContain(`paper: ${message}`);
  expect(stderr).toContain('npm run tool -- paper --mocap DIR');
  expect(status).toBe(1);
});
