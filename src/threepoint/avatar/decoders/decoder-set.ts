import type { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

/**
 * Means to unpack what is compressed, by the name of the extension. A file of its own: who loads avatars without any
 * must not load the workers that unpack.
 */
export type Decoders = Readonly<Record<string, (loader: GLTFLoader) => Promise<void>>>;
