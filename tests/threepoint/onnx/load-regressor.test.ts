import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { describe, expect, test } from 'vitest';
import { loadPlainRegressor } from '../../../src/threepoint/onnx/load-plain-regressor';
import { loadRegressor } from '../../../src/threepoint/onnx/load-regressor';
import { parseContract } from '../../../src/threepoint/onnx/model-contract';
import { answeringHost } from '../../rooms/client/answering-host';

const model = (name: string) => readFileSync(new URL(`../../../public/models/${name}`, import.meta.url));
const contract = JSON.parse(model('learned.json').toString()) as Record<string, unknown>;

type Files = Readonly<Record<string, Buffer | string>>;
/** Serves files by their names until the test is over; returns their folder. What is absent is a 404. */
async function served(files: Files): Promise<string> {
  const { folder } = await answeringHost(({ url = '' }, response) => {
    const file = files[basename(url)];
    response.writeHead(file === undefined ? 404 : 200).end(file);
  });
  return folder;
}

/** The shipped network with its contract changed, or its bytes. */
const changed = (changes: Record<string, unknown>, bytes: Buffer = model('learned.onnx')): Files => ({
  'learned.json': JSON.stringify({ ...contract, ...changes }),
  'learned.onnx': bytes,
});

describe('a network that is what its contract says', () => {
  test.each(['learned', 'paper'])('%s loads, and answers on WebAssembly', async (name) => {
    const files = [`${name}.json`, `${name}.onnx`];
    const folder = await served(Object.fromEntries(files.map((file) => [file, model(file)])));
    const shares: number[] = [];
    const regressor = await loadRegressor(`${folder}/${name}.json`, { onProgress: (share) => shares.push(share) });
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
    const folder = await served({ ...changed(changes), 'learned.bin': change(model('learned.bin')) });
    await expect(loadPlainRegressor(`${folder}/learned.json`)).rejects.toThrow(sentence);
  });
});

describe('a network that is not', () => {
  const bytes = model('learned.onnx');
  const [input] = contract.inputs as { shape: number[] }[];
  test.each<[string, Files, RegExp | string]>([
    ['a missing contract', {}, /^learned\.json: the server answers 404/],
    ['a missing model', changed({ file: 'gone.onnx' }), /^gone\.onnx: the server answers 404/],
    [
      'a truncated model',
      changed({}, bytes.subarray(0, 1000)),
      `learned.onnx: 1000 bytes long, its contract says ${bytes.length}`,
    ],
    [
      'a model with one bit changed',
      changed({}, Buffer.from(bytes).fill(bytes[5000]! ^ 1, 5000, 5001)),
      /^learned\.onnx: its SHA-256 begins [0-9a-f]{12}/,
    ],
    [
      'a model for features that the page does not make',
      changed({ inputs: [{ ...input, shape: [1, 54] }] }),
      /^learned\.json: expected 54 features, the page makes \d+/,
    ],
    [
      'a tensor with another name',
      changed({ inputs: [{ ...input, name: 'points' }] }),
      /^learned\.onnx: has the tensors .* its contract says points/,
    ],
  ])('%s', async (_, files, sentence) => {
    await expect(loadRegressor(`${await served(files)}/learned.json`)).rejects.toThrow(sentence);
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
