import { readFileSync, symlinkSync } from 'node:fs';
import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { ensureInstalled, missingInstallation } from '../../scripts/installation.mjs';
import { directoryWith } from '../temporary-directory';

type Packages = Record<string, { version?: string; optional?: boolean; optionalDependencies?: Record<string, string> }>;

function projectWith(wanted: Packages, installed: Packages | null): string {
  return directoryWith({
    'package-lock.json': JSON.stringify({ packages: wanted }),
    ...(installed && { 'node_modules/.package-lock.json': JSON.stringify({ packages: installed }) }),
  });
}

describe('what is missing', () => {
  const wanted = {
    '': { version: '0.1.0' },
    'node_modules/three': { version: '0.187.0' },
    'node_modules/fsevents': { version: '2.3.3', optional: true },
  };

  test('everything, in a fresh clone', () => {
    expect(missingInstallation(projectWith(wanted, null))).toBe('nothing is installed yet');
  });

  test('nothing, when what the lock file wants is there; another platform’s packages may be absent', () => {
    expect(missingInstallation(projectWith(wanted, { 'node_modules/three': { version: '0.187.0' } }))).toBeNull();
  });

  test('a package the lock file names newly or in another version', () => {
    expect(missingInstallation(projectWith(wanted, {}))).toBe('three 0.187.0 is missing');
    const older = { 'node_modules/three': { version: '0.186.0' } };
    expect(missingInstallation(projectWith(wanted, older))).toBe('three 0.187.0 is missing');
  });
});

test('a linked node_modules is left alone: npm ci would empty the folder it leads to', async () => {
  const wanted = { 'node_modules/three': { version: '0.187.0' } };
  const owner = projectWith(wanted, { 'node_modules/three': { version: '0.186.0' } });
  const borrower = projectWith(wanted, null);
  symlinkSync(join(owner, 'node_modules'), join(borrower, 'node_modules'), 'junction');
  const before = readFileSync(join(owner, 'node_modules/.package-lock.json'), 'utf8');
  await expect(ensureInstalled(borrower)).rejects.toThrow(
    /^three 0\.187\.0 is missing.*symbolic link.*remove the link/,
  );
  expect(readFileSync(join(owner, 'node_modules/.package-lock.json'), 'utf8')).toBe(before);
});
