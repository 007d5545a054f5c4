import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { directoryWith } from '../temporary-directory';

/** Runs the check with this Node in a project that requires the given range. */
function checkAgainst(engine: string) {
  const directory = directoryWith({
    'package.json': JSON.stringify({ engines: { node: engine } }),
    'scripts/require-node.cjs': readFileSync('scripts/require-node.cjs'),
  });
  const { status, stderr } = spawnSync(process.execPath, ['scripts/require-node.cjs'], {
    cwd: directory,
    encoding: 'utf8',
  });
  return { status, stderr };
}

const [major, minor] = process.versions.node.split('.').map(Number) as [number, number];

test.each([
  `>=${major}.0`,
  `>=${process.versions.node}`,
  `>=${major - 1}.99.99`,
  `^${major}.${minor}.0`,
  `^1.0.0 || >=${major}.0.0`,
  `^${major}.0.0 || >=${major + 2}.0.0`,
])('%s is met', (engine) => {
  expect(checkAgainst(engine)).toEqual({ status: 0, stderr: '' });
});

test.each([
  `>=${major + 1}.0`,
  `>=${major}.${minor + 1}.0`,
  `^${major - 1}.99.0`,
  `^${major}.${minor + 1}.0 || >=${major + 2}.0.0`,
])('%s is not, and the message names both versions', (engine) => {
  const { status, stderr } = checkAgainst(engine);
  expect(status).toBe(1);
  expect(stderr).toContain(`needs Node ${engine}; this is Node ${process.versions.node}`);
});
