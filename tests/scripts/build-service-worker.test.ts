import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { icons } from '../../scripts/build-icons.mjs';
import { keptFiles } from '../../scripts/build-service-worker.mjs';
import { directoryWith } from '../temporary-directory';

const built = {
  'index.html': '<title>page</title>',
  'results.html': '<title>results</title>',
  'experimenter.html': '<title>experimenter</title>',
  'withdraw.html': '<title>withdraw</title>',
  'api/rooms': '{"rooms":null}',
  'studies/paper.json': '{}',
  '.source-hash': 'hash',
  'favicon.svg': '<svg/>',
  'models/learned.bin': 'weights',
  'models/learned.json': 'a contract for the runtime',
  'models/learned.onnx': 'weights for the runtime',
  'assets/main-1.js': 'main',
  'assets/archery-2.js': 'later',
  'assets/shared-3.js': 'of two pages',
  'assets/results-4.js': 'charts',
  'assets/withdraw-9.js': 'a code and a receipt',
  'assets/worker-5.js': 'in no manifest',
  'assets/ort.webgpu.bundle.min-6.js': 'webgpu',
  'assets/ort-wasm-simd-threaded-7.wasm': 'the runtime',
};
const manifest = {
  'index.html': { file: 'assets/main-1.js', imports: ['_shared'], dynamicImports: ['archery'] },
  archery: { file: 'assets/archery-2.js', dynamicImports: ['index.html'] },
  _shared: { file: 'assets/shared-3.js' },
  'results.html': { file: 'assets/results-4.js', imports: ['_shared'] },
  'experimenter.html': { file: 'assets/results-4.js' },
  'withdraw.html': { file: 'assets/withdraw-9.js', imports: ['_shared'] },
};

test('the kept files are what the page may load, without server, other pages and onnxruntime-web', () => {
  expect(keptFiles(directoryWith(built), manifest).map(({ url }) => url)).toEqual([
    'assets/archery-2.js',
    'assets/main-1.js',
    'assets/shared-3.js',
    'assets/worker-5.js',
    'favicon.svg',
    'index.html',
    'models/learned.bin',
  ]);
});

test('each is known by its content, not by its name', () => {
  const before = keptFiles(directoryWith(built), manifest);
  const after = keptFiles(directoryWith({ ...built, 'models/learned.bin': 'better weights' }), manifest);
  const changed = after.filter((file, i) => file.integrity !== before[i]?.integrity);
  expect(changed.map(({ url }) => url)).toEqual(['models/learned.bin']);
  expect(changed[0]?.revision).not.toBe(before.find(({ url }) => url === 'models/learned.bin')?.revision);
  // A name that contains a hash of the content needs no revision.
  expect(after.find(({ url }) => url === 'assets/main-1.js')?.revision).toBeNull();
});

test('the manifest of the installed page names its own folder, and icons have their stated sizes', () => {
  const text = (path: string) => readFileSync(new URL(`../../public/${path}`, import.meta.url));
  const app = JSON.parse(text('manifest.webmanifest').toString()) as {
    start_url: string;
    scope: string;
    icons: { src: string; sizes: string; purpose: string }[];
  };
  expect([app.start_url, app.scope]).toEqual(['./', './']);
  const drawn = app.icons.filter(({ src }) => src.endsWith('.png'));
  expect(drawn.map(({ purpose }) => purpose)).toEqual(['any', 'any', 'maskable']);
  for (const { src, sizes } of drawn) expect(sizeOf(text(src)), src).toBe(sizes);
  for (const [name, { side }] of Object.entries(icons)) expect(sizeOf(text(`icons/${name}`))).toBe(`${side}x${side}`);
});

/** Returns the width and height in a PNG's header. */
function sizeOf(png: Buffer): string {
  expect(png.subarray(1, 4).toString()).toBe('PNG');
  return `${png.readUInt32BE(16)}x${png.readUInt32BE(20)}`;
}
