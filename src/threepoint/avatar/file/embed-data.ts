import * as v from 'valibot';
import { joinBytes } from '../../core/files';
import { packGlb } from '../../core/motion/gltf';
import { readGlbChunks } from './glb-chunks';

const index = v.pipe(v.number(), v.integer(), v.minValue(0));
const withAddress = v.looseObject({ uri: v.exactOptional(v.string()) });
/** The offset of data of compression stands in an extension. */
const compressed = v.exactOptional(v.looseObject({ buffer: index, byteOffset: v.optional(index, 0) }));
const description = v.looseObject({
  buffers: v.exactOptional(v.array(v.looseObject({ byteLength: index, uri: v.exactOptional(v.string()) }))),
  bufferViews: v.exactOptional(
    v.array(
      v.looseObject({
        buffer: index,
        byteOffset: v.optional(index, 0),
        extensions: v.exactOptional(
          v.looseObject({ EXT_meshopt_compression: compressed, KHR_meshopt_compression: compressed }),
        ),
      }),
    ),
  ),
  images: v.exactOptional(v.array(withAddress)),
});

/** Returns the type and the bytes of a data URL in base64; null: it is another URL. */
function contentOf(url: string | undefined, name: string) {
  const found = /^data:([^;,]*)(?:;[^;,]*)*;base64,/.exec(url ?? '');
  if (!found) return null;
  try {
    const bytes = Uint8Array.from(atob(url!.slice(found[0].length)), (letter) => letter.charCodeAt(0));
    return { type: found[1]!, bytes };
  } catch {
    throw new Error(`${name}: its numbers are not base64`);
  }
}

/**
 * Returns a glTF file, as text or GLB, as a GLB file with the contents of its data URLs in its binary part. Other
 * addresses stay, and a file that is no glTF is returned as it is. Throws an Error that names the file where a data
 * URL is not base64.
 */
export function embedData(file: Uint8Array<ArrayBuffer>, name: string): ArrayBuffer {
  const { json: text, binary } = readGlbChunks(file) ?? { json: new TextDecoder().decode(file), binary: null };
  const parsed = v.safeParse(v.pipe(v.string(), v.parseJson(), description), text);
  // The check of the file says what is wrong with it.
  if (!parsed.success) return file.buffer;
  const { output: json } = parsed;
  const pack = (pieces: readonly Uint8Array<ArrayBuffer>[]) => joinBytes(packGlb(json, pieces)).buffer;
  const pieces: Uint8Array<ArrayBuffer>[] = [];
  let length = 0;
  const append = (bytes: Uint8Array): number => {
    const begin = length;
    pieces.push(Uint8Array.from(bytes), new Uint8Array(-bytes.length & 3));
    length += bytes.length + (-bytes.length & 3);
    return begin;
  };
  const buffers = json.buffers ?? [];
  const contents = buffers.map(({ uri }, i) => contentOf(uri, name)?.bytes ?? (i === 0 && !uri ? binary : null));
  if (contents.includes(null)) return binary ? file.buffer : pack([]);
  const begins = contents.map((bytes) => append(bytes!));
  for (const view of json.bufferViews ?? []) {
    const { EXT_meshopt_compression, KHR_meshopt_compression } = view.extensions ?? {};
    for (const place of [view, EXT_meshopt_compression, KHR_meshopt_compression]) {
      if (!place) continue;
      place.byteOffset += begins[place.buffer] ?? 0;
      place.buffer = 0;
    }
  }
  for (const image of json.images ?? []) {
    const content = contentOf(image.uri, name);
    if (!content) continue;
    json.bufferViews ??= [];
    json.bufferViews.push({ buffer: 0, byteOffset: append(content.bytes), byteLength: content.bytes.length });
    Object.assign(image, { bufferView: json.bufferViews.length - 1, mimeType: content.type });
    delete image.uri;
  }
  if (length > 0) json.buffers = [{ byteLength: length }];
  return pack(pieces);
}
