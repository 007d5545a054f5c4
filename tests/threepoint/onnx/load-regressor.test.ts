import { readFileSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { loadPlainRegressor } from '../../../src/threepoint/onnx/load-plain-regressor';
import { loadRegressor } from '../../../src/threepoint/onnx/load-regressor';
import { parseContract } from '../../../src/threepoint/onnx/model-contract';

const model = (name: string) => readFileSync(new URL(`../../../public/models/${name}`, import.meta.url));
const contract = JSON.parse(model('learned.json').toString()) as Record<string, unknown>;

/** Files by path, served as a page's server would; what is absent is a 404. */
const files = new Map<string, Buffer | string>();
let server: Server;
let base = '';

beforeAll(async () => {
  server = createServer((request, response) => {
    const file = files.get(request.url ?? '');
    response.statusCode = file === undefined ? 404 : 200;
    response.end(file);
  });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  base = `http://127.0.0.1:${(server.address() as AddressInfo).port}`;
});

afterAll(async () => {
  await new Promise((resolve) => server.close(resolve));
});

/** Serves the shipped network with its contract changed, or its bytes. */
function serve(changes: Record<string, unknown>, bytes: Buffer = model('learned.onnx')): string {
  files.clear();
  files.set('/learned.json', JSON.stringify({ ...contract, ...changes }));
  files.set('/learned.onnx', bytes);
  return `${base}/learned.json`;
}

describe('a network that is what its contract says', () => {
  test.each(['learned', 'paper'])('%s loads, and answers on WebAssembly', async (name) => {
    files.clear();
    files.set(`/${name}.json`, model(`${name}.json`));
    files.set(`/${name}.onnx`, model(`${name}.onnx`));
    const shares: number[] = [];
    const regressor = await loadRegressor(`${base}/${name}.json`, { onProgress: (share) => shares.push(share) });
    expect(regressor.provider).toBe('wasm');
    expect(shares.at(-1)).toBe(1);
    const count = regressor.contract.inputs[0]?.shape.reduce((a, b) => a * b, 1) ?? 0;
    const output = await regressor.run(new Float32Array(count));
    expect(output).toHaveLength(18);
    expect(output.every(Number.isFinite)).toBe(true);
    await regressor.dispose();
    await expect(regressor.run(new Float32Array(count))).rejects.toThrow(`${name}.onnx: used after dispose`);
  });
});

describe('the learned network without a runtime', () => {
  function serveWeights(bytes: Buffer, changes: Record<string, unknown> = {}): string {
    files.clear();
    files.set('/learned.json', JSON.stringify({ ...contract, ...changes }));
    files.set('/learned.bin', bytes);
    return `${base}/learned.json`;
  }

  test.each([
    ['a bit changed', {}, (bytes: Buffer) => bytes.fill(1, 5000, 5001), /^learned\.bin: its SHA-256 begins/],
    ['half of them', {}, (bytes: Buffer) => bytes.subarray(0, 4000), /^learned\.bin: 4000 bytes long, its contract/],
    ['none named', { weights: undefined }, (bytes: Buffer) => bytes, /^learned\.json: names no weights/],
    [
      'none there',
      { weights: { ...(contract.weights as object), file: 'gone.bin' } },
      (bytes: Buffer) => bytes,
      /^gone\.bin: the server answers 404/,
    ],
    [
      'no list of tensors',
      { weights: { ...(contract.weights as object), tensors: { a: 'x' } } },
      (bytes: Buffer) => bytes,
      /^learned\.json: weights\.tensors\.a: /,
    ],
  ])('weights with %s', async (_, changes, change, sentence) => {
    await expect(loadPlainRegressor(serveWeights(change(model('learned.bin')), changes))).rejects.toThrow(sentence);
  });
});

describe('a network that is not', () => {
  const bytes = model('learned.onnx');
  const [input] = contract.inputs as { shape: number[] }[];
  test.each<[string, () => string, RegExp | string]>([
    ['a missing contract', () => `${base}/gone.json`, /^gone\.json: the server answers 404/],
    ['a missing model', () => serve({ file: 'gone.onnx' }), /^gone\.onnx: the server answers 404/],
    [
      'a truncated model',
      () => serve({}, bytes.subarray(0, 1000)),
      `learned.onnx: 1000 bytes long, its contract says ${bytes.length}`,
    ],
    [
      'a model with one bit changed',
      () => serve({}, Buffer.from(bytes).fill(bytes[5000]! ^ 1, 5000, 5001)),
      /^learned\.onnx: its SHA-256 begins [0-9a-f]{12}/,
    ],
    [
      'a model for features that the page does not make',
      () => serve({ inputs: [{ ...input, shape: [1, 54] }] }),
      /^learned\.json: expected 54 features, the page makes \d+/,
    ],
    [
      'a tensor with another name',
      () => serve({ inputs: [{ ...input, name: 'points' }] }),
      /^learned\.onnx: has the tensors .* its contract says points/,
    ],
  ])('%s', async (_, url, sentence) => {
    await expect(loadRegressor(url())).rejects.toThrow(sentence);
  });

  test('a contract that is no JSON, or lacks a field', () => {
    expect(() => parseContract('learned.json', '{')).toThrow(/^learned\.json: no valid JSON/);
    expect(() => parseContract('learned.json', JSON.stringify({ ...contract, sha256: 'abc' }))).toThrow(
      'learned.json: sha256: expected 64 hexadecimal digits',
    );
  });
});
