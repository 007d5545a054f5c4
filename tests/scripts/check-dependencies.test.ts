import { expect, test } from 'vitest';
import { dependencyFaults, readProject } from '../../scripts/check-dependencies.mjs';

const document = `
| shipped dependency | package | reason |
|---|---|---|
| three, ws | page, room | drawing and sockets |

| for development | reason |
|---|---|
| vitest | tests |
`;
const locked = { version: '1.0.0', integrity: 'sha512-AA==', license: 'MIT' };
const project = {
  lock: {
    packages: {
      'node_modules/page': { resolved: 'src/page', link: true },
      'node_modules/three': { ...locked, license: 'Apache-2.0 AND BSL-1.0' },
      'node_modules/three/node_modules/ws': { ...locked, license: 'GPL-2.0 OR MIT' },
      'node_modules/vitest': { ...locked, license: 'MPL-2.0', dev: true },
    },
  },
  manifests: {
    '.': { name: 'workspace', devDependencies: { vitest: '1.0.0' } },
    'src/page': { name: 'page', dependencies: { three: '1.0.0', ws: '1.0.0', room: '1.0.0' } },
    'src/room': { name: 'room', dependencies: { ws: '1.0.0' }, peerDependencies: { three: '>=1' } },
  },
  document,
};
const withPackage = (entry: object) => ({
  ...project,
  lock: { packages: { ...project.lock.packages, 'node_modules/three': { ...locked, ...entry } } },
});

test('dependencies with one version, a hash, a permissive licence and a reason have no fault', () => {
  expect(dependencyFaults(project)).toEqual([]);
});

test.each([
  ['copyleft in what ships', withPackage({ license: 'LGPL-3.0-or-later' }), 'three 1.0.0 ships with the licence LGPL'],
  ['copyleft in a part of it', withPackage({ license: 'MIT AND GPL-3.0-only' }), 'three 1.0.0 ships with the licence'],
  ['no licence', withPackage({ license: undefined }), 'three 1.0.0 ships with the licence (none)'],
  ['no hash', withPackage({ integrity: undefined }), 'no SHA-512 hash of three 1.0.0'],
  ['a weak hash', withPackage({ integrity: 'sha1-AA==' }), 'no SHA-512 hash of three 1.0.0'],
  ['another source', withPackage({ resolved: 'https://evil.example/three.tgz' }), 'fetches three from https://evil'],
  [
    'a range of versions',
    { ...project, manifests: { ...project.manifests, '.': { name: 'w', devDependencies: { vitest: '^1.0.0' } } } },
    './package.json asks for vitest ^1.0.0',
  ],
  ['no reason', { ...project, document: document.replace('three, ws', 'three') }, 'no reason for ws, which page, room'],
  ['no reason for a tool', { ...project, document: document.replace('vitest', 'jest') }, 'no reason for vitest'],
  ['a row too many', { ...project, document: document.replace('ws', 'ws, gone') }, 'has gone, which nothing ships'],
  ['another package', { ...project, document: document.replace('page, room', 'page') }, 'has three in page; the'],
])('%s is a fault', (_, faulty, sentence) => {
  expect(dependencyFaults(faulty).join('\n')).toContain(sentence);
});

test('the dependencies of this repository have no fault', () => {
  expect(dependencyFaults(readProject())).toEqual([]);
});
