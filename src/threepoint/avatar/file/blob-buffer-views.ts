import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';

/** The parts of a GLB file's JSON that locate its bytes. */
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
 * Reads the buffer views of a GLB from a Blob of the file: meshes are copied one by one, images are slices of the Blob,
 * which the browser decodes on another thread. GLTFLoader copies the whole binary chunk, and each image twice, on the
 * page's thread.
 */
export const blobBufferViews =
  (binary: Uint8Array, file: Blob) =>
  (parser: GLTFParser): GLTFLoaderPlugin => {
    const { bufferViews = [], images = [] } = parser.json as Description;
    const pictures = new Set(images.map(({ bufferView }) => bufferView));
    return {
      name: 'threepoint_views',
      beforeRoot() {
        // Meshopt reads the whole chunk, which is copied on demand.
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
        // reason: GLTFLoader passes a picture's view to a new Blob, which accepts a Blob; the types allow bytes only.
        return Promise.resolve(part as unknown as ArrayBuffer);
      },
    };
  };
