import { expect, test } from 'vitest';
import { ownScriptAddress } from '../../src/ui/trusted-types';

const folder = 'https://example.org/threepoint';

test.each(['https://example.org/threepoint/assets/inference-worker-3f2a.js', 'assets/check-worker-77aa.js', 'sw.js'])(
  '%s is a file of the build',
  (address) => {
    expect(ownScriptAddress(address, folder)).toBe(new URL(address, `${folder}/`).href);
  },
);

test.each([
  'https://elsewhere.example/threepoint/assets/a.js',
  'https://example.org/assets/a.js',
  '/uploads/a.js',
  'assets/../uploads/a.js',
  'assets/%2e%2e/uploads/a.js',
  '//elsewhere.example/assets/a.js',
  'data:text/javascript,0',
  'blob:https://example.org/0f0f',
  'javascript:0',
])('%s is none', (address) => {
  expect(ownScriptAddress(address, folder)).toBeNull();
});
