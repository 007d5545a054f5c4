import type { FlatWeights } from './pose-regressor';

/** The numbers of one tensor, row by row, and its size in each dimension. */
export interface Tensor {
  readonly shape: readonly number[];
  readonly numbers: Float32Array | Int16Array | Int8Array;
}

const arrays = { float32: Float32Array, int16: Int16Array, int8: Int8Array } as const;

const isType = (name: string | undefined): name is keyof typeof arrays => name !== undefined && name in arrays;

/**
 * Returns the tensors of a file of flat weights by name. Throws an Error if the file's length does not match its list,
 * or a number is not finite.
 */
export function readWeights({ file, tensors }: FlatWeights, bytes: Uint8Array): ReadonlyMap<string, Tensor> {
  // A copy is aligned for every typed array.
  const { buffer } = new Uint8Array(bytes);
  const read = new Map<string, Tensor>();
  let offset = 0;
  for (const [name, form] of Object.entries(tensors)) {
    const [type, ...sizes] = form.split(' ');
    const shape = sizes.map(Number);
    if (!isType(type) || shape.length === 0 || !shape.every((size) => Number.isInteger(size) && size > 0)) {
      throw new Error(`${file}: ${name}: “${form}” is no type and shape`);
    }
    const count = shape.reduce((product, size) => product * size, 1);
    const array = arrays[type];
    if (offset + count * array.BYTES_PER_ELEMENT > buffer.byteLength) throw new Error(`${file}: ends before ${name}`);
    const numbers = new array(buffer, offset, count);
    if (!numbers.every(Number.isFinite)) throw new Error(`${file}: ${name} has numbers that are not finite`);
    read.set(name, { shape, numbers });
    offset += numbers.byteLength;
  }
  if (offset !== buffer.byteLength) {
    throw new Error(`${file}: ${buffer.byteLength} bytes long, its tensors are ${offset}`);
  }
  return read;
}

/** Returns the numbers of a tensor; throws if it is missing or has another shape. */
export function tensorOf(weights: ReadonlyMap<string, Tensor>, name: string, ...shape: number[]): Tensor['numbers'] {
  const tensor = weights.get(name);
  if (!tensor) throw new Error(`no tensor is called ${name}`);
  if (shape.join() !== tensor.shape.join()) {
    throw new Error(`${name} is ${tensor.shape.join(' × ')}, expected ${shape.join(' × ')}`);
  }
  return tensor.numbers;
}
