import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { expect, test } from 'vitest';
import { nextVersion, release, releaseNotes } from '../../scripts/release.mjs';
import { directoryWith } from '../temporary-directory';

const library = { name: 'library', version: '0.1.0', dependencies: { three: '0.1.0' } };
const rooms = {
  name: 'rooms',
  version: '0.1.0',
  dependencies: { library: '0.1.0' },
  peerDependencies: { library: '0.1.0' },
};

/** Creates a repository at version 0.1.0 with these files in .changes. */
function repository(changes: Readonly<Record<string, string>>): string {
  const lock = {
    version: '0.1.0',
    packages: {
      '': { name: 'workspace', version: '0.1.0' },
      'src/library': library,
      server: rooms,
      'node_modules/three': { version: '0.1.0' },
    },
  };
  return directoryWith({
    'package.json': JSON.stringify({ name: 'workspace', version: '0.1.0' }),
    'package-lock.json': JSON.stringify(lock),
    'src/library/package.json': JSON.stringify(library),
    'server/package.json': JSON.stringify(rooms),
    'CHANGELOG.md': '# Changelog\n\n## 0.1.0\n\nThe first release.\n',
    ...Object.fromEntries(Object.entries(changes).map(([name, text]) => [`.changes/${name}.md`, text])),
  });
}
const read = (directory: string, path: string) => readFileSync(join(directory, path), 'utf8');

test.each([
  ['0.1.9', ['patch'], '0.1.10'],
  ['0.1.9', ['patch', 'minor'], '0.2.0'],
  ['1.2.3', ['minor', 'major', 'patch'], '2.0.0'],
])('after %s comes, with %j, %s', (version, asked, next) => {
  expect(nextVersion(version, asked)).toBe(next);
});

test('a release gives every package one version, and moves the changes into CHANGELOG.md', () => {
  const directory = repository({
    bow: 'minor: Added\nThe bow has\na sight.\n',
    arrow: 'patch: Fixed\n\nArrows no longer pass through the ground.\n',
  });
  expect(release(directory)).toBe('0.2.0');
  const moved = {
    ...rooms,
    version: '0.2.0',
    dependencies: { library: '0.2.0' },
    peerDependencies: { library: '0.2.0' },
  };
  expect(JSON.parse(read(directory, 'server/package.json'))).toEqual(moved);
  expect(JSON.parse(read(directory, 'package-lock.json'))).toEqual({
    version: '0.2.0',
    packages: {
      '': { name: 'workspace', version: '0.2.0' },
      'src/library': { ...library, version: '0.2.0' },
      server: moved,
      'node_modules/three': { version: '0.1.0' },
    },
  });
  const notes = '### Added\n\n- The bow has\n  a sight.\n\n### Fixed\n\n- Arrows no longer pass through the ground.';
  expect(read(directory, 'CHANGELOG.md')).toBe(
    `# Changelog\n\n## 0.2.0\n\n${notes}\n\n## 0.1.0\n\nThe first release.\n`,
  );
  expect(existsSync(join(directory, '.changes/bow.md'))).toBe(false);
  expect(releaseNotes('0.2.0', directory)).toBe(notes);
});

test('a release without changes, and a change without a kind, are refused', () => {
  expect(() => release(repository({}))).toThrow('There is nothing to release');
  expect(() => release(repository({ bow: 'The bow has a sight.' }))).toThrow('.changes/bow.md: expected a first line');
});

test('the notes of a version that a package or CHANGELOG.md does not have are refused', () => {
  expect(releaseNotes('0.1.0', repository({}))).toBe('The first release.');
  expect(() => releaseNotes('0.2.0', repository({}))).toThrow('rooms has version 0.1.0, library has');
});

test('every package of this repository has the version that CHANGELOG.md begins with', () => {
  const [, version = ''] = /^## (.*)$/m.exec(readFileSync('CHANGELOG.md', 'utf8')) ?? [];
  expect(releaseNotes(version)).not.toBe('');
});
