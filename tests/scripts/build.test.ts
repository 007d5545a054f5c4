import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { buildOptions } from '../../scripts/build.mjs';
import { root } from '../../scripts/run-command.mjs';
import { directoryWith } from '../temporary-directory';

describe('npm run build', () => {
  test('makes a page for any folder, in dist/', () => {
    expect(buildOptions([])).toEqual({ base: './', out: join(root, 'dist'), filesFrom: null });
  });

  test.each(['./', '/', '/threepoint/', '/~ann/bodies/v1.2/'])('makes one for the folder %s', (base) => {
    expect(buildOptions(['--base', base]).base).toBe(base);
    expect(buildOptions([`--base=${base}`]).base).toBe(base);
  });

  test.each([
    '',
    'threepoint',
    '/threepoint',
    'threepoint/',
    '..',
    '../',
    '/a/../b/',
    '//host/',
    '/a b/',
    '/<a>/',
    'https://a.example/',
  ])('refuses the folder "%s" in a sentence', (base) => {
    expect(() => buildOptions(['--base', base])).toThrow(
      /^--base .*expected the path of a folder with a slash at either end/,
    );
  });

  test.each([[['--base']], [['--bas', '/a/']], [['/threepoint/']]])('says what it takes when asked for %j', (args) => {
    expect(() => buildOptions(args)).toThrow('npm run build takes --base');
  });

  test('empties no directory that it has not filled', () => {
    const strange = directoryWith({ 'thesis.txt': 'years of work' });
    expect(() => buildOptions(['--out', strange])).toThrow('a build would delete them');
    expect(() => buildOptions(['--out', ''])).toThrow('expected a directory');
    const before = directoryWith({ 'index.html': '', '.source-hash': '' });
    for (const out of [before, directoryWith(), join(before, 'new')]) {
      expect(buildOptions(['--out', out]).out).toBe(out);
    }
  });
});
