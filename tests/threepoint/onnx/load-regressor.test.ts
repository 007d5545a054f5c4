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

  test('loads, and answers at once', async () => {
    const shares: number[] = [];
    const url = serveWeights(model('learned.bin'));
    const regressor = await loadPlainRegressor(url, (share) => shares.push(share));
    expect(regressor.provider).toBe('plain');
    expect(shares.at(-1)).toBe(1);
    const output = regressor.runNow?.(new Float32Array(regressor.contract.inputs[0]!.shape.at(-1)!));
    expect(output).toHaveLength(18);
    expect(output?.every(Number.isFinite)).toBe(true);
  });

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
  test('a missing contract', async () => {
    files.clear();
    await expect(loadRegressor(`${base}/learned.json`)).rejects.toThrow(/^learned\.json: the server answers 404/);
  });

  test('a missing model', async () => {
    const url = serve({});
    files.delete('/learned.onnx');
    await expect(loadRegressor(url)).rejects.toThrow(/^learned\.onnx: the server answers 404/);
  });

  test('a truncated model', async () => {
    const bytes = model('learned.onnx');
    const url = serve({}, bytes.subarray(0, 1000));
    await expect(loadRegressor(url)).rejects.toThrow(
      `learned.onnx: 1000 bytes long, its contract says ${bytes.length}`,
    );
  });

  test('a model with one bit changed', async () => {
    const bytes = Buffer.from(model('learned.onnx'));
    bytes[5000] = (bytes[5000] ?? 0) ^ 1;
    await expect(loadRegressor(serve({}, bytes))).rejects.toThrow(/^learned\.onnx: its SHA-256 begins [0-9a-f]{12}/);
  });

  test('a model for features that the page does not make', async () => {
    const [input] = contract.inputs as { shape: number[] }[];
    const url = serve({ inputs: [{ ...input, shape: [1, 54] }] });
    await expect(loadRegressor(url)).rejects.toThrow(/^learned\.json: expected 54 features, the page makes \d+/);
  });

  test('a tensor with another name', async () => {
    const [input] = contract.inputs as { shape: number[] }[];
    const url = serve({ inputs: [{ ...input, name: 'points' }] });
    await expect(loadRegressor(url)).rejects.toThrow(/^learned\.onnx: has the tensors .* its contract says points/);
  });

  test('a model for features in the axes of the room', () => {
    const [input] = contract.inputs as object[];
    const inRoom = JSON.stringify({ ...contract, inputs: [{ ...input, frame: 'floor' }] });
    expect(() => parseContract('paper.json', inRoom)).toThrow(/^paper\.json: inputs\.0\.frame: .*"floor"/);
  });

  test('a contract that is no JSON, or lacks a field', () => {
    expect(() => parseContract('learned.json', '{')).toThrow(/^learned\.json: no valid JSON/);
    expect(() => parseContract('learned.json', JSON.stringify({ ...contract, sha256: 'abc' }))).toThrow(
      'learned.json: sha256: expected 64 hexadecimal digits',
    );
  });
});
