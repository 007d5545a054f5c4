import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { commandOf, steps } from '../../scripts/renew.mjs';
import { root } from '../../scripts/run-command.mjs';
import { directoryWith } from '../temporary-directory';

const text = (path: string) => readFileSync(join(root, path), 'utf8');
const node = (args: readonly string[], cwd = root) => {
  const env = { ...process.env, INIT_CWD: undefined };
  return spawnSync(process.execPath, args, { cwd, encoding: 'utf8', env });
};

describe('the command line of each step', () => {
  // Options are parsed in order, and the first unknown one ends the script before it starts: here it is the last one.
  test.each(steps.filter(({ script }) => script !== 'train').map((step) => [step.name, step] as const))(
    '%s has options that its script accepts',
    (_, step) => {
      const { stderr, status } = node([...commandOf(step, 'DIR'), '--no-such-option']);
      expect(stderr).toContain(`${step.script}: Unknown option '--no-such-option'`);
      expect(status).toBe(1);
    },
  );

  test('has options that the training accepts', () => {
    const parser = text('training/threepoint_training/__main__.py');
    const known = [...parser.matchAll(/(?:add_argument\(\s*|^ {4})"(--[a-z0-9-]+)"/gm)].map(([, option]) => option);
    const asked = steps.filter(({ script }) => script === 'train').flatMap((step) => commandOf(step, 'DIR').slice(1));
    expect(known).toEqual(expect.arrayContaining(asked.filter((word) => word.startsWith('--'))));
    const stages = text('training/threepoint_training/training_config.py').match(/stages: .+ = \((.+)\)/)?.[1];
    for (const [at, word] of asked.entries()) if (word === '--stage') expect(stages).toContain(`"${asked[at + 1]}"`);
  });
});

describe('a run', () => {
  test('ends with the failing step, in the intended folder, and says how to go on', () => {
    const folder = directoryWith();
    const { stdout, stderr, status } = node(
      [join(root, 'scripts/renew.mjs'), '--mocap', 'none', '--from', 'goldens'],
      folder,
    );
    expect(stdout).toContain('renew 1 of 1, goldens: ');
    expect(stderr).toContain(`goldens: ${join(folder, 'none')}: no such folder`);
    expect(stderr).toMatch(/renew: the step goldens ended with exit code 1; its messages are above/);
    expect(stderr).toContain('npm run tool -- renew --mocap none --from goldens\n');
    expect(status).toBe(1);
  });
});
