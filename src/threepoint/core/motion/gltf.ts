/** The parts of a glTF file's description that a clip adds to; all else is kept as it is. */
export interface GltfDescription {
  [field: string]: unknown;
  accessors?: unknown[];
  bufferViews?: unknown[];
  buffers?: { byteLength: number; uri?: string }[];
  animations?: unknown[];
}

/** The rotations (x, y, z, w) or translations [m] of a node at the times of a clip. */
export interface NodeTrack {
  readonly node: number;
  readonly path: 'rotation' | 'translation';
  readonly values: Float32Array;
}

export interface Clip {
  readonly name: string;
  /** The times of all tracks [s], rising. */
  readonly times: Float32Array;
  readonly tracks: readonly NodeTrack[];
  /** Custom fields of the animation. */
  readonly extras: object;
}

const float = 5126;

/**
 * Puts a clip, as the only one, into a description whose binary part is `binaryLength` bytes long; the clip is
 * interpolated along straight lines and shorter arcs. Returns what follows that part, after padding to four bytes.
 */
export function addClip(
  description: GltfDescription,
  binaryLength: number,
  { name, times, tracks, extras }: Clip,
): Uint8Array<ArrayBuffer> {
  description.accessors ??= [];
  description.bufferViews ??= [];
  const { accessors, bufferViews } = description;
  const padding = (4 - (binaryLength % 4)) % 4;
  const length = 4 * tracks.reduce((sum, { values }) => sum + values.length, times.length);
  const more = new Uint8Array(padding + length);
  let at = padding;
  const accessor = (values: Float32Array, type: string, bounds: object = {}): number => {
    more.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), at);
    bufferViews.push({ buffer: 0, byteOffset: binaryLength + at, byteLength: values.byteLength });
    at += values.byteLength;
    const size = type === 'SCALAR' ? 1 : type === 'VEC3' ? 3 : 4;
    const count = values.length / size;
    return accessors.push({ bufferView: bufferViews.length - 1, componentType: float, count, type, ...bounds }) - 1;
  };
  const input = accessor(times, 'SCALAR', { min: [times[0]], max: [times.at(-1)] });
  const samplers = tracks.map(({ path, values }) => ({
    input,
    output: accessor(values, path === 'rotation' ? 'VEC4' : 'VEC3'),
    interpolation: 'LINEAR',
  }));
  const channels = tracks.map(({ node, path }, sampler) => ({ sampler, target: { node, path } }));
  description.animations = [{ name, samplers, channels, extras }];
  const byteLength = binaryLength + more.length;
  const [first, ...others] = description.buffers ?? [];
  description.buffers = [{ ...first, byteLength }, ...others];
  return more;
}

/** The first word of a GLB file, and the kinds of its two chunks. */
export const glbMagic = 0x46546c67;
export const jsonChunk = 0x4e4f534a;
export const binaryChunk = 0x004e4942;

/** Returns a value as JSON in ASCII, with escapes for all other characters, padded to four bytes. */
function asciiJson(value: unknown): Uint8Array<ArrayBuffer> {
  const text = JSON.stringify(value).replace(
    /[\u0080-\uffff]/g,
    (unit) => `\\u${unit.charCodeAt(0).toString(16).padStart(4, '0')}`,
  );
  const padded = text.padEnd(Math.ceil(text.length / 4) * 4, ' ');
  const bytes = new Uint8Array(padded.length);
  for (let i = 0; i < padded.length; i++) bytes[i] = padded.charCodeAt(i);
  return bytes;
}

const words = (...values: number[]): Uint8Array<ArrayBuffer> => {
  const bytes = new Uint8Array(4 * values.length);
  const view = new DataView(bytes.buffer);
  for (const [i, value] of values.entries()) view.setUint32(4 * i, value, true);
  return bytes;
};

/** Returns the bytes of a GLB file, in parts. */
export function packGlb(
  description: GltfDescription,
  binary: readonly Uint8Array<ArrayBuffer>[],
): readonly Uint8Array<ArrayBuffer>[] {
  const json = asciiJson(description);
  const length = binary.reduce((sum, part) => sum + part.length, 0);
  const padding = new Uint8Array((4 - (length % 4)) % 4);
  const whole = 12 + 8 + json.length + 8 + length + padding.length;
  return [
    words(glbMagic, 2, whole, json.length, jsonChunk),
    json,
    words(length + padding.length, binaryChunk),
    ...binary,
    padding,
  ];
}
