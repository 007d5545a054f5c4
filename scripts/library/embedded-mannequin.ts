/** Returns the bytes of the mannequin's VRM file, which the published package contains as code. */
export async function readBundledMannequin(): Promise<ArrayBuffer> {
  const { default: file } = await import('../../public/avatars/mannequin.vrm');
  return file.buffer;
}
