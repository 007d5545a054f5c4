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
 * Reads the buffer views of a GLB from its binary chunk: meshes are read one by one, images are slices of the Blob,
 * which the browser decodes on another thread. GLTFLoader copies the whole chunk, and each image twice, on the page's
 * thread.
 */
export const blobBufferViews =
  (binary: Blob) =>
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
              return binary.arrayBuffer();
            },
          },
        });
        return null;
      },
      loadBufferView(index) {
        const view = bufferViews[index];
        if (!view || Object.keys(view.extensions ?? {}).some(isPacked)) return null;
        const from = view.byteOffset ?? 0;
        const part = binary.slice(from, from + view.byteLength);
        if (!pictures.has(index)) return part.arrayBuffer();
        // reason: GLTFLoader passes a picture's view to a new Blob, which accepts a Blob; the types allow bytes only.
        return Promise.resolve(part as unknown as ArrayBuffer);
      },
    };
  };
