/**
 * Returns the file of the mannequin that this package brings. In the repository it is a file next to the page; in the
 * published package a module with the same bytes takes the place of this one, so that no bundler can lose them
 * (scripts/build-library.mjs).
 */
export async function readBundledMannequin(): Promise<ArrayBuffer> {
  const response = await fetch(new URL('../../../public/avatars/mannequin.vrm', import.meta.url).href);
  if (!response.ok) throw new Error(`mannequin.vrm: the server answers ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}
