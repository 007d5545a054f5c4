import type { Avatar } from 'threepoint/three';

/** Lets another person's body be drawn with fewer triangles at a distance. Without WebAssembly it keeps all of them. */
export async function simplifyAtDistance(avatar: Avatar): Promise<Avatar> {
  const { MeshoptSimplifier } = await import('meshoptimizer/simplifier');
  if (!MeshoptSimplifier.supported) return avatar;
  await MeshoptSimplifier.ready;
  await avatar.simplifyAtDistance(MeshoptSimplifier);
  return avatar;
}
