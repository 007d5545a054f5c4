import { afterAll, describe, expect, test } from 'vitest';
import { avatarLimits } from '../../../src/threepoint/avatar/file/avatar-limits';
import { checkAvatar, gltfFaults } from '../../../src/threepoint/avatar/file/check-avatar';
import { imageSize } from '../../../src/threepoint/avatar/file/image-size';
import { inspectAvatar } from '../../../src/threepoint/avatar/file/inspect-avatar';
import { parseAvatar, parseChecked } from '../../../src/threepoint/avatar/load-avatar';
import { reportFigures } from '../../reliability/report-figures';
import { changed, type GltfJson, mannequin, pngHeader, withPictures } from './glb';
import { largeAvatar } from './large-avatar';

const look = (bytes: ArrayBuffer) => inspectAvatar(new Uint8Array(bytes), 'person.vrm');

const first = <Item>(items: readonly Item[]): Item => items[0] as Item;

/** What of a GLB file lies before its binary part. */
const descriptionOf = (file: ArrayBuffer) => file.slice(0, 20 + new DataView(file).getUint32(12, true));

/** The mannequin's file, whose binary part is said to be so many bytes long. */
function withBinaryLength(length: number): ArrayBuffer {
  const file = mannequin();
  new DataView(file).setUint32(descriptionOf(file).byteLength, length, true);
  return file;
}

/** A KTX2 texture of this size [pixels]: its header alone. */
function ktx2Header(width: number, height: number): Buffer {
  const bytes = Buffer.from('\xabKTX 20\xbb\r\n\x1a\n'.padEnd(80, '\0'), 'latin1');
  bytes.writeUInt32LE(width, 20);
  bytes.writeUInt32LE(height, 24);
  return bytes;
}

test('KTX2 textures are read where the page has their decoder, within the limits of pictures', () => {
  const look = (width: number) =>
    inspectAvatar(new Uint8Array(withPictures(1, ktx2Header(width, 64))), 'person.vrm', ['KHR_texture_basisu']);
  expect(() => look(64)).not.toThrow();
  expect(() => look(16_384)).toThrow(/16384 pixels across picture 0/);
});

const ktx2Sentence = /has KTX2 textures, which .* Convert them to PNG, JPEG or WebP and save it again\./;

/** What the description of a file may say, and the sentence for it. */
const claims: readonly (readonly [string, (json: GltfJson) => void, RegExp])[] = [
  [
    'triangles without end',
    (json) => Object.assign(json.accessors[first(first(json.meshes).primitives).indices ?? 0]!, { count: 3_000_000 }),
    /triangles; an avatar may have 250000 at most/,
  ],
  [
    'one mesh hung up a hundred times',
    (json) => json.nodes.push(...Array.from({ length: 100 }, (_, i) => ({ name: `again ${i}`, mesh: 0 }))),
    /triangles; an avatar may have 250000 at most/,
  ],
  [
    'accessors of zeros that need no bytes in the file',
    (json) => json.accessors.push({ count: 2 ** 30, type: 'VEC4', componentType: 5126 }),
    /million numbers; an avatar may have 40 at most/,
  ],
  [
    'bones without end',
    (json) => Object.assign(first(json.skins), { joints: Array.from({ length: 601 }, (_, i) => i) }),
    /601 bones; an avatar may have 600 at most/,
  ],
  [
    'nodes without end',
    (json) => json.nodes.push(...Array.from({ length: 4000 }, (_, i) => ({ name: `${i}` }))),
    /nodes; an avatar may have 4000 at most/,
  ],
  [
    'morph targets without end',
    (json) => {
      // The head of the mannequin has one in each of its two primitives.
      first(first(json.meshes).primitives).targets = Array.from({ length: 3999 }, () => ({ POSITION: 0 }));
    },
    /4001 morph targets; an avatar may have 4000 at most/,
  ],
  [
    'a picture on a server',
    (json) => Object.assign(json, { images: [{ uri: 'https://elsewhere.example/x.png' }] }),
    /outside the file/,
  ],
  [
    'a picture beside the page',
    (json) => Object.assign(json, { images: [{ uri: '../../healthz' }] }),
    /outside the file/,
  ],
  [
    'bytes on a server',
    (json) => Object.assign(first(json.buffers), { uri: '//elsewhere.example/x.bin' }),
    /outside the file/,
  ],
  [
    'an address inside an extension',
    ({ extensions }) => Object.assign(extensions, { EXT_of_tomorrow: [{ deep: { uri: 'file:///etc/passwd' } }] }),
    /outside the file \(file:\/\/\/etc\/passwd\)/,
  ],
  ['JSON that is none', (json) => Object.assign(json, { nodes: 'everything' }), /not a VRM or GLB file/],
  ['a negative count', (json) => Object.assign(first(json.accessors), { count: -1 }), /not a VRM or GLB file/],
  [
    'a description without an end to its depth',
    (json) => {
      let deep: unknown[] = [];
      for (let i = 0; i < 500; i++) deep = [deep];
      json.extras = deep;
    },
    /person\.vrm: not a VRM or GLB file \(is nested deeper than 64 levels\)/,
  ],
  [
    'a need for KTX2 textures',
    (json) => Object.assign(json, { extensionsRequired: ['KHR_texture_basisu'] }),
    ktx2Sentence,
  ],
];

/** What a user may try, and the sentence for it. */
const attempts: readonly (readonly [string, () => ArrayBuffer, RegExp])[] = [
  ...claims.map(([name, claim, sentence]) => [name, () => changed(claim), sentence] as const),
  ['more bytes than a headset takes', () => new ArrayBuffer(61 * 2 ** 20), /61 MB; an avatar may have 60 at most/],
  ['textures without end', () => withPictures(65, pngHeader(64, 64)), /65 textures; an avatar may have 64 at most/],
  [
    'a picture larger than a texture can be',
    () => withPictures(1, pngHeader(16_384, 16)),
    /16384 pixels across picture 0/,
  ],
  [
    'many large pictures',
    () => withPictures(7, pngHeader(4096, 4096)),
    /million pixels; an avatar may have 96 at most/,
  ],
  ['a picture that is none', () => withPictures(1, Buffer.from('<svg onload="alert(1)"/>')), /picture 0 is no PNG/],
  ['a KTX2 texture that it does not need', () => withPictures(1, ktx2Header(64, 64)), ktx2Sentence],
  ['a file that is cut short', () => mannequin().slice(0, 3000), /truncated/],
  ['a file without its last word', () => mannequin().slice(0, -4), /truncated/],
  ['a file that is cut off within a mesh', () => mannequin().slice(0, -20_000), /truncated/],
  ['a file of which only the description has arrived', () => descriptionOf(mannequin()), /truncated/],
  ['a binary part that is said to be longer than the file', () => withBinaryLength(2 ** 31), /truncated/],
];

let refused = 0;
afterAll(() =>
  reportFigures('avatars', {
    'files refused': `${refused} of ${attempts.length + compressions.length + broken.length}`,
    limits: `${avatarLimits.megabytes} MB, ${avatarLimits.triangles / 1000} k triangles, ${avatarLimits.textures} textures of ${avatarLimits.texturePixels} pixels, ${avatarLimits.bones} bones`,
  }),
);

describe('an avatar from a file', () => {
  test.each(attempts)('with %s is refused, by name and limit', (_, file, sentence) => {
    expect(() => look(file())).toThrow(/^person\.vrm: /);
    expect(() => look(file())).toThrow(sentence);
  });

  test('like ours passes', () => {
    expect(() => look(mannequin())).not.toThrow();
    expect(() => look(withPictures(20, pngHeader(2048, 1024)))).not.toThrow();
  });

  test('is looked at in milliseconds, also where it claims to hold more', () => {
    const file = first(attempts.filter(([name]) => name.startsWith('accessors')))[1]();
    const before = process.memoryUsage().arrayBuffers;
    expect(() => look(file)).toThrow();
    expect(process.memoryUsage().arrayBuffers - before).toBeLessThan(50e6);
  });
});

const compressions = ['EXT_meshopt_compression', 'KHR_meshopt_compression', 'KHR_draco_mesh_compression'];

/** Says that the file cannot be read without this, and marks its buffers as compressed by it. */
const compressed = (extension: string) =>
  changed((json) => {
    json.extensionsUsed.push(extension);
    json.extensionsRequired = [extension];
    const extensions = { [extension]: { buffer: 0, byteLength: 10, byteStride: 4, count: 1, mode: 'ATTRIBUTES' } };
    for (const view of json.bufferViews) Object.assign(view, { extensions });
  });

describe('a compressed body', () => {
  // A rejection that no part of the page waits for ends a test run: the loader must not have begun.
  test.each(compressions)('%s is refused in one sentence, before the loader begins', async (extension) => {
    const sentence = `person.vrm: is compressed (${extension}); this page reads avatars that are saved without compression`;
    const rejections: unknown[] = [];
    const onRejection = (reason: unknown) => void rejections.push(reason);
    process.on('unhandledRejection', onRejection);
    await expect(parseAvatar(compressed(extension), 'person.vrm')).rejects.toThrow(sentence);
    await new Promise((resolve) => setImmediate(resolve));
    process.off('unhandledRejection', onRejection);
    expect(rejections).toEqual([]);
    refused += 1;
  });

  test('is read where a VRM of others needs its extensions', () => {
    const file = changed((json) => {
      json.extensionsRequired = ['VRMC_vrm', 'VRMC_materials_mtoon', 'KHR_materials_unlit', 'KHR_texture_transform'];
    });
    expect(() => look(file)).not.toThrow();
  });
});

/** Opens a file with the check that the page's worker runs. */
const checked = (bytes: ArrayBuffer) => checkAvatar(bytes, { name: 'person.vrm', supportedCompressions: [] });
const opened = async (bytes: ArrayBuffer) => parseChecked(await checked(bytes));

/** Well within every limit, and wrong all the same. */
const broken: readonly (readonly [string, (json: GltfJson) => void])[] = [
  [
    'indices beyond its corners',
    (json) => Object.assign(first(first(json.meshes).primitives).attributes, { POSITION: 9999 }),
  ],
  [
    'an accessor that reads past its bytes',
    (json) => {
      const accessor = json.accessors.find(({ bufferView }) => bufferView !== undefined);
      if (accessor) accessor.count += 10;
    },
  ],
  [
    'a bone that is its own grandchild',
    (json) => {
      const child = json.nodes[first(json.nodes).children?.[0] ?? 1];
      if (child) child.children = [0];
    },
  ],
];

const positionsIn = ({ accessors, meshes }: GltfJson) =>
  accessors[first(first(meshes).primitives).attributes.POSITION!]!;

/** Faults of files of others, which three.js reads all the same. */
const readable: readonly (readonly [string, (json: GltfJson) => void])[] = [
  [
    'a skin whose root carries a part of its joints alone',
    (json) => Object.assign(first(json.skins), { skeleton: first(json.skins).joints.at(-1) }),
  ],
  [
    'bounds that are smaller than the numbers',
    (json) => Object.assign(positionsIn(json), { min: [0, 0, 0], max: [0.01, 0.01, 0.01] }),
  ],
  ['bounds that are not there', (json) => Object.assign(positionsIn(json), { min: undefined, max: undefined })],
  ['an extension that is not declared', (json) => Object.assign(first(json.nodes), { extensions: { EXT_x: {} } })],
  ['empty lists', (json) => Object.assign(json, { cameras: [], textures: [] })],
  [
    'a camera that sees nothing',
    (json) => Object.assign(json, { cameras: [{ type: 'perspective', perspective: { yfov: 0, znear: 0 } }] }),
  ],
];

describe('the Khronos validator', () => {
  test.each(readable)('lets %s pass', async (_, change) => {
    expect((await opened(changed(change))).name).toBe('person.vrm');
  });

  test.each(broken)('refuses %s', async (_, change) => {
    await expect(opened(changed(change))).rejects.toThrow(/^person\.vrm: not valid glTF \(/);
    refused += 1;
  });

  test('takes ours', async () => {
    expect(await gltfFaults(new Uint8Array(mannequin()))).toEqual([]);
    expect((await opened(mannequin())).name).toBe('person.vrm');
  });

  test('is not asked what the limits have refused', async () => {
    for (const [, file, sentence] of attempts) {
      await expect(checked(file())).rejects.toThrow(sentence);
      refused += 1;
    }
  });
});

test('the large file that the benchmark loads is taken', async () => {
  const file = largeAvatar({ pictures: 1, layers: 1, shapes: 40, mtoon: true });
  expect((await checkAvatar(file, { name: 'measured.vrm', supportedCompressions: [] })).usedCompressions).toEqual([]);
});

describe('the size of a picture', () => {
  test('is read from the header of a PNG, JPEG and WebP', () => {
    expect(imageSize(pngHeader(300, 200))).toEqual({ width: 300, height: 200 });
    const jpeg = [0xff, 0xd8, 0xff, 0xe0, 0, 4, 0, 0, 0xff, 0xc2, 0, 11, 8, 1, 44, 0, 200, 1, 0, 0, 0];
    expect(imageSize(Uint8Array.from(jpeg))).toEqual({ width: 200, height: 300 });
    const webp = Buffer.alloc(30);
    webp.write('RIFF....WEBPVP8X', 0, 'latin1');
    webp.writeUIntLE(299, 24, 3);
    webp.writeUIntLE(199, 27, 3);
    expect(imageSize(webp)).toEqual({ width: 300, height: 200 });
  });

  test('is none for anything else, and none for one cut short', () => {
    for (const text of ['', 'GIF89a', '<svg/>', '\x89PNG', 'RIFF....WEBP'])
      expect(imageSize(Buffer.from(text, 'latin1'))).toBeNull();
    expect(imageSize(Uint8Array.from([0xff, 0xd8, 0xff, 0xe0, 0, 4]))).toBeNull();
  });
});
