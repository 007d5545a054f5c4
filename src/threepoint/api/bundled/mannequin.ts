/** Returns the mannequin's VRM file. The published package has scripts/library/embedded-mannequin.ts instead. */
export async function readBundledMannequin(): Promise<ArrayBuffer> {
  const response = await fetch(new URL('../../../../public/avatars/mannequin.vrm', import.meta.url).href);
  if (!response.ok) throw new Error(`mannequin.vrm: the server answers ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}
