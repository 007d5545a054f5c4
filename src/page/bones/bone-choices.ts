import {
  type BoneMap,
  type BoneName,
  boneNames,
  fingerBoneSuffixes,
  neededBones,
  vrmFingerNames,
} from 'threepoint/core';
import { sides } from 'threepoint/math';
import type { SkeletonToMap } from './skeleton-to-map';

const trunk = {
  hips: 'Hips',
  spine: 'Spine',
  chest: 'Chest',
  upperChest: 'Upper chest',
  neck: 'Neck',
  head: 'Head',
  jaw: 'Jaw',
  leftEye: 'Left eye',
  rightEye: 'Right eye',
};
const arm = { Shoulder: 'shoulder (collarbone)', UpperArm: 'upper arm', LowerArm: 'forearm', Hand: 'hand' };
const leg = { UpperLeg: 'thigh', LowerLeg: 'lower leg', Foot: 'foot', Toes: 'toes' };
const fingers = Object.fromEntries(
  vrmFingerNames.flatMap((finger) =>
    fingerBoneSuffixes(finger).map((bone, i) => [
      bone,
      `${finger.toLowerCase()} ${finger === 'Thumb' ? '' : 'finger '}${i + 1}`,
    ]),
  ),
);

type Labels = readonly (readonly [bone: BoneName, label: string])[];

/** Labels the same parts of both sides, in one group for each side. */
const sidedGroups = (name: string, labels: Readonly<Record<string, string>>) =>
  sides.map((side) => {
    const sideLabel = side === 'left' ? 'Left' : 'Right';
    const parts = Object.entries(labels).map(
      ([bone, label]) => [`${side}${bone}` as BoneName, `${sideLabel} ${label}`] as const,
    );
    return { label: `${sideLabel} ${name}`, parts };
  });

/** The parts of a body that a bone can be, in groups. */
export const partGroups: readonly { readonly label: string; readonly parts: Labels }[] = [
  { label: 'Trunk and head', parts: Object.entries(trunk) as unknown as Labels },
  ...sidedGroups('arm', arm),
  ...sidedGroups('leg', leg),
  ...sidedGroups('fingers', fingers),
];

const labels = new Map(partGroups.flatMap(({ parts }) => parts));

/** Returns the name of a part of a body for the user. */
export const labelOfPart = (part: BoneName): string => labels.get(part) ?? part;

const needed: ReadonlySet<string> = new Set(neededBones);
export const isNeeded = (part: BoneName): boolean => needed.has(part);

/** A match below this confidence is shown as unsure. */
const sureFrom = 0.75;

/** Assigns the bones of a file to the parts of a body, each at most once. */
export class BoneChoices {
  readonly joints: SkeletonToMap['joints'];
  readonly #confidence: SkeletonToMap['confidence'];
  readonly #guesses: BoneMap;
  /** The first joint with each name: a map names its bones. */
  readonly #byName = new Map<string, number>();
  readonly #partOf = new Map<number, BoneName>();

  constructor({ joints, bones, confidence }: Pick<SkeletonToMap, 'joints' | 'bones' | 'confidence'>) {
    this.joints = joints;
    this.#confidence = confidence;
    this.#guesses = bones;
    for (const [i, { name }] of joints.entries()) if (name !== '' && !this.#byName.has(name)) this.#byName.set(name, i);
    for (const [part, name] of Object.entries(bones)) {
      const joint = this.#byName.get(name);
      if (joint !== undefined && boneNames.has(part)) this.#partOf.set(joint, part as BoneName);
    }
  }

  /** Whether a map can name this joint: it has a name that no joint before it has. */
  canChoose(joint: number): boolean {
    return this.#byName.get(this.joints[joint]!.name) === joint;
  }

  /** Returns the name of a joint for the user. */
  fileNameOf(joint: number): string {
    const { name, end } = this.joints[joint]!;
    return end ? `end of ${name.replace(/:end$/, '')}` : name;
  }

  /** Returns the part that a bone is; null: no part of the body. */
  partOf(joint: number): BoneName | null {
    return this.#partOf.get(joint) ?? null;
  }

  /** Returns the joint of a part; −1: no bone is this part. */
  jointOf(part: BoneName): number {
    for (const [joint, each] of this.#partOf) if (each === part) return joint;
    return -1;
  }

  /** The joints of parts that both sides have, left and right. */
  get pairs(): readonly (readonly [left: number, right: number])[] {
    return [...this.#partOf].flatMap(([left, part]) => {
      const right = part.startsWith('left') ? this.jointOf(part.replace('left', 'right') as BoneName) : -1;
      return right < 0 ? [] : [[left, right] as const];
    });
  }

  /** Assigns a bone to a part of the body, which no other bone is then; null: to none. */
  assign(joint: number, part: BoneName | null): void {
    this.#partOf.delete(part ? this.jointOf(part) : joint);
    if (part) this.#partOf.set(joint, part);
  }

  /** Whether the matcher only guessed this bone and the user has not changed it. */
  isUnsure(joint: number): boolean {
    const part = this.partOf(joint);
    return (
      part !== null && this.#guesses[part] === this.joints[joint]!.name && (this.#confidence[part] ?? 1) < sureFrom
    );
  }

  get bones(): BoneMap {
    return Object.fromEntries([...this.#partOf].map(([joint, part]) => [part, this.joints[joint]!.name]));
  }

  /** The needed parts that no bone is. */
  get missing(): readonly BoneName[] {
    return neededBones.filter((part) => this.jointOf(part) < 0);
  }
}
