import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';

/** What of a GLB file's description says where its bytes are. */
interface Description {
  readonly bufferViews?: readonly {
    readonly byteOffset?: number;
    readonly byteLength: number;
    readonly extensions?: Readonly<Record<string, unknown>>;
  }[];
  readonly images?: readonly { readonly bufferView?: number }[];
}

const isPacked = (extension: string): boolean => extension.endsWith('meshopt_compression');

/**
 * Reads a GLB's parts from where they lie: meshes are cut out one by one, pictures are parts of a blob of the file,
 * which the browser reads and decodes elsewhere. The loader itself copies the file's binary as a whole and each picture
 * twice, on the page's thread.
 */
export const viewsOfFile =
  (binary: Uint8Array, file: Blob) =>
  (parser: GLTFParser): GLTFLoaderPlugin => {
    const { bufferViews = [], images = [] } = parser.json as Description;
    const pictures = new Set(images.map(({ bufferView }) => bufferView));
    return {
      name: 'threepoint_views',
      beforeRoot() {
        // Meshopt reads from the whole, which is copied when it asks.
        Object.assign(parser.extensions, {
          KHR_binary_glTF: {
            get body() {
              return binary.slice().buffer;
            },
          },
        });
        return null;
      },
      loadBufferView(index) {
        const view = bufferViews[index];
        if (!view || Object.keys(view.extensions ?? {}).some(isPacked)) return null;
        const from = view.byteOffset ?? 0;
        const to = from + view.byteLength;
        if (!pictures.has(index)) return Promise.resolve(binary.slice(from, to).buffer);
        const part = file.slice(binary.byteOffset + from, binary.byteOffset + to);
        // reason: a picture's view goes into a new Blob, which takes a blob as it takes bytes; the types know of
        // bytes alone.
        return Promise.resolve(part as unknown as ArrayBuffer);
      },
    };
  };
