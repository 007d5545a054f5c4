import { fingerBoneSuffixes } from '../body/finger-bone-names';
import { type Side, sides } from '../math/side';

const centreBones = ['hips', 'spine', 'chest', 'upperChest', 'neck', 'head', 'jaw'] as const;
const sideBones = ['Shoulder', 'UpperArm', 'LowerArm', 'Hand', 'UpperLeg', 'LowerLeg', 'Foot', 'Toes', 'Eye'] as const;
/** The fingers as VRM's names of bones have them, from the thumb outwards. */
export const vrmFingerNames = ['Thumb', 'Index', 'Middle', 'Ring', 'Little'] as const;
type Finger = (typeof vrmFingerNames)[number];

/** VRM's name of a bone. The declarations of @pixiv/three-vrm do not resolve under Node's rules for modules. */
export type BoneName =
  | (typeof centreBones)[number]
  | `${Side}${
      | (typeof sideBones)[number]
      | `Thumb${'Metacarpal' | 'Proximal' | 'Distal'}`
      | `${Exclude<Finger, 'Thumb'>}${'Proximal' | 'Intermediate' | 'Distal'}`}`;
/** VRM's names of bones, and the names of their nodes in a file. */
export type BoneMap = Readonly<Partial<Record<BoneName, string>>>;

/** VRM's names of all bones of a hand's fingers, without the side. */
export const handFingerBones: readonly string[] = vrmFingerNames.flatMap(fingerBoneSuffixes);

/** Every bone that a map may name. */
export const boneNames: ReadonlySet<string> = new Set([
  ...centreBones,
  ...sides.flatMap((side) => [...sideBones, ...handFingerBones].map((bone) => side + bone)),
]);

/** Bones without which there is no upper body to move. */
export const neededBones = [
  'hips',
  'spine',
  'head',
  'leftUpperArm',
  'leftLowerArm',
  'leftHand',
  'rightUpperArm',
  'rightLowerArm',
  'rightHand',
] as const satisfies readonly BoneName[];
