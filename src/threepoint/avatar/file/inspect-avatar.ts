import * as v from 'valibot';
import { reasonOf } from '../../core/errors/reasons';
import { type AvatarLimits, avatarLimits } from './avatar-limits';
import { readGlbChunks } from './glb-chunks';
import { imageSize, isKtx2 } from './image-size';
import { MotionOnlyError } from './motion-only-error';

const index = v.pipe(v.number(), v.integer(), v.minValue(0));
const list = <Item extends v.GenericSchema>(item: Item) => v.optional(v.array(item), []);
const primitive = v.object({
  attributes: v.record(v.string(), index),
  indices: v.optional(index),
  mode: v.optional(index, 4),
  targets: list(v.record(v.string(), index)),
});
const packedView = v.optional(v.object({ count: index, byteStride: index }));
const gltf = v.object({
  extensionsRequired: list(v.string()),
  extensionsUsed: list(v.string()),
  nodes: list(v.object({ mesh: v.optional(index), children: list(index) })),
  meshes: list(v.object({ primitives: v.array(primitive) })),
  accessors: list(v.object({ count: index, type: v.optional(v.string(), 'SCALAR') })),
  skins: list(v.object({ joints: v.array(index) })),
  bufferViews: list(
    v.object({
      buffer: index,
      byteOffset: v.optional(index, 0),
      byteLength: index,
      extensions: v.optional(
        v.object({ EXT_meshopt_compression: packedView, KHR_meshopt_compression: packedView }),
        {},
      ),
    }),
  ),
  buffers: list(v.object({ byteLength: index, uri: v.optional(v.string()) })),
  animations: list(v.unknown()),
  images: list(v.object({ uri: v.optional(v.string()), bufferView: v.optional(index) })),
});

/** Extensions without which a file cannot be read, and which this page reads. */
const readable =
  /^(VRM|VRMC_\w+|KHR_materials_(?!variants)\w+|KHR_(texture_transform|mesh_quantization|lights_punctual)|EXT_(texture_webp|texture_avif|materials_bump))$/;
const compression = /draco|meshopt/;

const numbersOf: Readonly<Record<string, number>> = {
  SCALAR: 1,
  VEC2: 2,
  VEC3: 3,
  VEC4: 4,
  MAT2: 4,
  MAT3: 9,
  MAT4: 16,
};
/** The largest fraction of JSON in a file's bytes. */
const maxJsonFraction = 0.25;

const ktx2Advice =
  'has KTX2 textures, which this page does not read. Convert them to PNG, JPEG or WebP and save it again.';

/** The deepest nesting of the JSON, because readers are recursive. */
const deepestNesting = 64;

/**
 * Returns the URLs in the file: each value with the key `uri`, at any depth, extensions included. `extras` are left
 * out, because no reader follows them. Throws if the nesting is too deep.
 */
function urisIn(json: unknown): string[] {
  const uris: string[] = [];
  const waiting = [{ value: json, depth: 0, isNote: false }];
  for (let next = waiting.pop(); next; next = waiting.pop()) {
    const { value, depth, isNote } = next;
    if (typeof value !== 'object' || value === null) continue;
    if (depth > deepestNesting) throw new Error(`is nested deeper than ${deepestNesting} levels`);
    for (const [key, inner] of Object.entries(value)) {
      if (key === 'uri' && typeof inner === 'string' && !isNote) uris.push(inner);
      waiting.push({ value: inner, depth: depth + 1, isNote: isNote || key === 'extras' });
    }
  }
  return uris;
}

type Gltf = v.InferOutput<typeof gltf>;
/** Throws an Error that names the file if a measure exceeds its limit, or is not a number. */
type Limit = (what: string, has: number, may: number) => void;

/**
 * Throws an Error that names the file and the limit if the avatar exceeds a limit or refers to another file. Reads
 * headers alone: nothing is decoded, allocated or fetched. `unpacked`: the supported extensions of compression. Returns
 * those that the file uses.
 */
export function inspectAvatar(
  bytes: Uint8Array,
  name: string,
  unpacked: readonly string[] = [],
  limits: AvatarLimits = avatarLimits,
): readonly string[] {
  const limit: Limit = (what, has, may) => {
    if (!(has <= may))
      throw new Error(`${name}: ${shownNumber(has)} ${what}; an avatar may have ${shownNumber(may)} at most`);
  };
  limit('MB', bytes.length / 2 ** 20, limits.megabytes);
  const chunks = readGlbChunks(bytes);
  if (!chunks) {
    const isPage = /^[\ufeff\s]*</.test(new TextDecoder().decode(bytes.subarray(0, 100)));
    const why = isPage ? 'a web page: is the address right?' : 'wrong signature, or truncated';
    throw new Error(`${name}: not a VRM or GLB file (${why})`);
  }
  limit('MB of description', chunks.json.length / 2 ** 20, limits.megabytes * maxJsonFraction);
  const description = parseDescription(chunks.json, name);
  if (description.meshes.length === 0) {
    if (description.animations.length > 0) throw new MotionOnlyError(name);
    throw new Error(`${name}: holds nothing that could be seen: it has no meshes`);
  }
  const { extensionsRequired, extensionsUsed } = description;
  assertReadable(extensionsRequired, name, unpacked);
  limitScene(description, limit, limits);
  limitImages(description, chunks.binary, { name, limit, limits, ktx2: unpacked.includes('KHR_texture_basisu') });
  return unpacked.filter((extension) => extensionsUsed.includes(extension) || extensionsRequired.includes(extension));
}

/** Parses the JSON of a file. Throws an Error that names the file if it is no glTF, or refers to another file. */
function parseDescription(text: string, name: string): Gltf {
  let json: unknown;
  let uris: readonly string[];
  try {
    json = JSON.parse(text);
    uris = urisIn(json);
  } catch (error) {
    throw new Error(`${name}: not a VRM or GLB file (${reasonOf(error)})`);
  }
  if (uris.length > 0) {
    const shown = uris[0]!.slice(0, 60);
    throw new Error(`${name}: refers to something outside the file (${shown}); an avatar must hold everything itself`);
  }
  const parsed = v.safeParse(gltf, json);
  if (parsed.success) return parsed.output;
  const [issue] = parsed.issues;
  throw new Error(`${name}: not a VRM or GLB file (${v.getDotPath(issue) ?? 'the whole'}: ${issue.message})`);
}

/** Throws an Error that names the file if it requires an extension that this page does not read. */
function assertReadable(required: readonly string[], name: string, unpacked: readonly string[]): void {
  const foreign = required.find((extension) => !readable.test(extension) && !unpacked.includes(extension));
  if (foreign === undefined) return;
  if (foreign === 'KHR_texture_basisu') throw new Error(`${name}: ${ktx2Advice}`);
  throw new Error(
    compression.test(foreign)
      ? `${name}: is compressed (${foreign}); this page reads avatars that are saved without compression`
      : `${name}: needs ${foreign.slice(0, 60)}, which this page does not read`,
  );
}

/** Limits the nodes, bones and meshes of a file, and the memory of their numbers. */
function limitScene({ nodes, meshes, accessors, skins, bufferViews }: Gltf, limit: Limit, limits: AvatarLimits): void {
  limit('nodes', nodes.length, limits.nodes);
  limit('bones', new Set(skins.flatMap(({ joints }) => joints)).size, limits.bones);
  const primitives = meshes.flatMap((mesh) => mesh.primitives);
  const targets = primitives.reduce((sum, { targets }) => sum + targets.length, 0);
  limit('morph targets', targets, limits.morphTargets);
  const numbers = accessors.reduce((sum, { count, type }) => sum + count * (numbersOf[type] ?? 16), 0);
  limit('million numbers', numbers / 1e6, limits.millionNumbers);
  // A number has at least one byte: the decoded size of the views is limited as that of the accessors.
  const bytesUnpacked = bufferViews.reduce((sum, { extensions }) => {
    const packed = extensions.EXT_meshopt_compression ?? extensions.KHR_meshopt_compression;
    return sum + (packed ? packed.count * packed.byteStride : 0);
  }, 0);
  limit('million unpacked bytes', bytesUnpacked / 1e6, limits.millionNumbers * 4);
  const corners = (mesh: number) =>
    (meshes[mesh]?.primitives ?? []).reduce((sum, { attributes, indices, mode }) => {
      const count = accessors[indices ?? attributes.POSITION ?? -1]?.count ?? 0;
      // Strips and fans have a triangle for each corner but two, lists for each three.
      return sum + (mode === 4 ? count / 3 : count);
    }, 0);
  // A mesh is drawn once for each node that refers to it.
  const triangles = nodes.reduce((sum, { mesh }) => sum + (mesh === undefined ? 0 : corners(mesh)), 0);
  limit('triangles', triangles, limits.triangles);
}

/** Limits the images of a file by their headers. Throws an Error that names the file if one cannot be shown. */
function limitImages(
  { images, bufferViews }: Gltf,
  binary: Uint8Array,
  { name, limit, limits, ktx2 }: { name: string; limit: Limit; limits: AvatarLimits; ktx2: boolean },
): void {
  limit('textures', images.length, limits.textures);
  let pixels = 0;
  images.forEach(({ bufferView }, i) => {
    const where = bufferView === undefined ? undefined : bufferViews[bufferView];
    const start = where?.byteOffset ?? 0;
    const picture = where && binary.subarray(start, start + where.byteLength);
    if (picture && isKtx2(picture) && !ktx2) throw new Error(`${name}: ${ktx2Advice}`);
    const size = picture && imageSize(picture);
    if (!size) throw new Error(`${name}: picture ${i} is no PNG, JPEG or WebP`);
    limit(`pixels across picture ${i}`, Math.max(size.width, size.height), limits.texturePixels);
    pixels += size.width * size.height;
  });
  limit('million pixels', pixels / 1e6, limits.millionPixels);
}

const shownNumber = (value: number): string =>
  value < 100 ? String(Number(value.toFixed(1))) : String(Math.round(value));
