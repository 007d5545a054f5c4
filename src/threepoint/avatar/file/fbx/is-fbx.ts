const latin = new TextDecoder('latin1');
const magic = 'Kaydara FBX Binary  \0';

export const isBinaryFbx = (bytes: Uint8Array): boolean => latin.decode(bytes.subarray(0, magic.length)) === magic;

/** Returns whether a file is FBX. FBX as text has no signature, and a converted file keeps its name. */
export const isFbx = (bytes: Uint8Array, name: string): boolean =>
  isBinaryFbx(bytes) || (/\.fbx$/i.test(name) && latin.decode(bytes.subarray(0, 4)) !== 'glTF');
