import { Bone, type Object3D, Vector3 } from 'three';
import { type BoneName, handFingerBones } from '../../core/humanoid/bones';
import { type Side, sides } from '../../core/math/side';
import { placeOf, skinMovedBy } from '../scene-meshes';

type Bones = ReadonlyMap<BoneName, Object3D>;

/** Returns the mean of these places; null: there is none. */
const middle = (places: readonly Vector3[]): Vector3 | null =>
  places.length > 0 ? places.reduce((sum, place) => sum.add(place), new Vector3()).divideScalar(places.length) : null;

/** Returns the nodes of the bones of fingers that leave a forearm: known bones, or chains as many as fingers are. */
function fingersOf(bones: Bones, side: Side, forearm: Object3D): readonly Object3D[] {
  const known = handFingerBones.flatMap((finger) => bones.get(`${side}${finger}` as BoneName) ?? []);
  const leaving = known.filter((node) => node.parent === forearm);
  const chains = chainsOf(forearm);
  return leaving.length > 0 ? leaving : chains.length >= fewestFingers ? chains : [];
}

const fewestFingers = 3;
const chainsOf = ({ children }: Object3D) => children.filter((child) => child.children.length > 0);

/**
 * Returns the place where a forearm's skin ends; null: it moves no skin. It runs from the elbow towards the middle of
 * its skin; where that is the elbow itself, it continues the upper arm.
 */
function endOfSkin(scene: Object3D, upperArm: Object3D, forearm: Object3D): Vector3 | null {
  const skin = skinMovedBy(scene, new Set([forearm]));
  const elbow = placeOf(forearm);
  const along = middle(skin)?.sub(elbow);
  if (!along) return null;
  along.addScaledVector(elbow.clone().sub(placeOf(upperArm)), 0.1).normalize();
  const far = skin.reduce((most, place) => Math.max(most, place.sub(elbow).dot(along)), 0);
  return elbow.addScaledVector(along, far);
}

/**
 * Adds hand joints to a scene at rest whose arms have none: where fingers leave the forearm, else where its skin ends.
 * Returns them by their bones. An arm that goes on, or has neither fingers nor skin, gets none.
 */
export function addHands(scene: Object3D, bones: Bones): Bones {
  const made = new Map<BoneName, Object3D>();
  for (const side of sides) {
    const upperArm = bones.get(`${side}UpperArm`);
    const forearm = bones.get(`${side}LowerArm`);
    if (!upperArm || !forearm || bones.has(`${side}Hand`)) continue;
    const fingers = fingersOf(bones, side, forearm);
    // A chain that is no finger may be the hand under another name.
    const isLast = chainsOf(forearm).length === 0;
    const place = middle(fingers.map(placeOf)) ?? (isLast ? endOfSkin(scene, upperArm, forearm) : null);
    if (!place) continue;
    const hand = new Bone();
    hand.name = `${side}Hand`;
    hand.position.copy(forearm.worldToLocal(place));
    forearm.add(hand);
    hand.updateWorldMatrix(false, false);
    for (const finger of fingers) hand.attach(finger);
    made.set(`${side}Hand`, hand);
  }
  return made;
}
