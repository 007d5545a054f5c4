/**
 * Returns the bytes of the mannequin's VRM file. In the repository they are fetched; the published package replaces
 * this module by one that contains the bytes, because some bundlers drop files (scripts/build-library.mjs).
 */
export async function readBundledMannequin(): Promise<ArrayBuffer> {
  const response = await fetch(new URL('../../../public/avatars/mannequin.vrm', import.meta.url).href);
  if (!response.ok) throw new Error(`mannequin.vrm: the server answers ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}
