import { fingerBones } from '../../core/body/finger-bones';
import type { Side } from '../../core/math/side';

type SideNames = 'Shoulder' | 'UpperArm' | 'LowerArm' | 'Hand' | 'UpperLeg' | 'LowerLeg' | 'Foot' | 'Toes' | 'Eye';
type CentreBone = 'hips' | 'spine' | 'chest' | 'upperChest' | 'neck' | 'head' | 'jaw';
const fingerNames = ['Thumb', 'Index', 'Middle', 'Ring', 'Little'] as const;
type Finger = (typeof fingerNames)[number];

/** VRM's names of all bones of a hand's fingers, without the side. */
export const handFingerBones: readonly string[] = fingerNames.flatMap(fingerBones);

/**
 * VRM's name of a bone. In words of our own: the declarations of @pixiv/three-vrm cannot be read where modules are
 * resolved as Node does.
 */
export type BoneName =
  | CentreBone
  | `${Side}${
      | SideNames
      | `Thumb${'Metacarpal' | 'Proximal' | 'Distal'}`
      | `${Exclude<Finger, 'Thumb'>}${'Proximal' | 'Intermediate' | 'Distal'}`}`;
/** VRM's names of bones, and what a file calls their nodes. */
export type BoneMap = Readonly<Partial<Record<BoneName, string>>>;

/**
 * How programs of one kind call the bones of a body. A space stands for the separator of words: none, `_`, `.`, `-` or
 * a blank.
 */
interface Naming {
  readonly centre: Partial<Readonly<Record<CentreBone, string>>>;
  /** `$` is the side, as `left` and `right` here have it. */
  readonly sides: Partial<Readonly<Record<SideNames, string>>>;
  readonly left: string;
  readonly right: string;
  /**
   * `$` as above, `#` the number of the phalanx from the palm (1, 2, 3), `%` VRM's name of the bone without the side.
   */
  readonly fingers: Readonly<Record<Finger, string>>;
}

const sides = { left: 'Left', right: 'Right' };
const mixamoLegs = { UpperLeg: '$UpLeg', LowerLeg: '$Leg', Foot: '$Foot', Toes: '$ToeBase', Eye: '$Eye' };
const fingersBy = (form: (finger: Finger) => string): Naming['fingers'] =>
  Object.fromEntries(fingerNames.map((finger) => [finger, form(finger)])) as Naming['fingers'];
/** The little finger is the pinky, the middle one at times the mid. */
const other = (names: Partial<Record<Finger, string>>) => (finger: Finger) => names[finger] ?? finger;
const pinky = other({ Little: 'Pinky' });

const unreal = {
  ...{ left: 'l', right: 'r' },
  sides: {
    ...{ Shoulder: 'clavicle $', UpperArm: 'upperarm $', LowerArm: 'lowerarm $', Hand: 'hand $' },
    ...{ UpperLeg: 'thigh $', LowerLeg: 'calf $', Foot: 'foot $', Toes: 'ball $', Eye: 'eye $' },
  },
  fingers: fingersBy((finger) => `${pinky(finger)} 0# $`),
};
const unrealCentre = (chest: string, upperChest: string) =>
  ({ hips: 'pelvis', spine: 'spine 01', chest, upperChest, neck: 'neck 01', head: 'head' }) as const;
const rigify = {
  ...{ left: 'L', right: 'R' },
  sides: {
    ...{ Shoulder: 'shoulder $', UpperArm: 'upper_arm $', LowerArm: 'forearm $', Hand: 'hand $' },
    ...{ UpperLeg: 'thigh $', LowerLeg: 'shin $', Foot: 'foot $', Toes: 'toe $', Eye: 'eye $' },
  },
  fingers: fingersBy((finger) => (finger === 'Thumb' ? 'thumb 0# $' : `f ${pinky(finger)} 0# $`)),
};
const characterCreator = {
  ...{ left: 'L', right: 'R' },
  sides: {
    ...{ Shoulder: '$ Clavicle', UpperArm: '$ Upperarm', LowerArm: '$ Forearm', Hand: '$ Hand' },
    ...{ UpperLeg: '$ Thigh', LowerLeg: '$ Calf', Foot: '$ Foot', Toes: '$ ToeBase', Eye: '$ Eye' },
  },
  fingers: fingersBy((finger) => `$ ${other({ Little: 'Pinky', Middle: 'Mid' })(finger)}#`),
};

/**
 * The namings this page knows, by what people call them. Sources: Mixamo's and Ready Player Me's exports, VRoid Studio,
 * Unreal's mannequins 4 and 5, Blender's Rigify (deform bones and metarig), Reallusion's Character Creator, 3ds Max's
 * Biped.
 */
const namings: Readonly<Record<string, Naming>> = {
  'Mixamo, Ready Player Me, Avaturn': {
    ...sides,
    centre: { hips: 'Hips', spine: 'Spine', chest: 'Spine1', upperChest: 'Spine2', neck: 'Neck', head: 'Head' },
    sides: { ...mixamoLegs, Shoulder: '$Shoulder', UpperArm: '$Arm', LowerArm: '$ForeArm', Hand: '$Hand' },
    fingers: fingersBy((finger) => `$Hand${pinky(finger)}#`),
  },
  VRoid: {
    ...{ left: 'L', right: 'R' },
    centre: {
      ...{ hips: 'C Hips', spine: 'C Spine', chest: 'C Chest', upperChest: 'C UpperChest' },
      ...{ neck: 'C Neck', head: 'C Head' },
    },
    sides: {
      ...{ Shoulder: '$ Shoulder', UpperArm: '$ UpperArm', LowerArm: '$ LowerArm', Hand: '$ Hand' },
      ...{ UpperLeg: '$ UpperLeg', LowerLeg: '$ LowerLeg', Foot: '$ Foot', Toes: '$ ToeBase' },
    },
    fingers: fingersBy((finger) => `$ ${finger}#`),
  },
  'Unreal 5': {
    ...unreal,
    centre: unrealCentre('spine 03', 'spine 05'),
  },
  'Unreal 4': {
    ...unreal,
    centre: unrealCentre('spine 02', 'spine 03'),
  },
  Rigify: {
    ...rigify,
    centre: {
      ...{ hips: 'spine', spine: 'spine 001', chest: 'spine 002', upperChest: 'spine 003' },
      ...{ neck: 'spine 004', head: 'spine 006' },
    },
  },
  'Rigify, named': {
    ...rigify,
    centre: { hips: 'hips', spine: 'spine', chest: 'chest', upperChest: 'upper chest', neck: 'neck', head: 'head' },
  },
  'Character Creator': {
    ...characterCreator,
    centre: {
      ...{ hips: 'Hip', spine: 'Waist', chest: 'Spine01', upperChest: 'Spine02' },
      ...{ neck: 'NeckTwist01', head: 'Head', jaw: 'JawRoot' },
    },
  },
  Biped: {
    ...characterCreator,
    centre: { hips: 'Pelvis', spine: 'Spine', chest: 'Spine1', upperChest: 'Spine2', neck: 'Neck', head: 'Head' },
    sides: { ...characterCreator.sides, Toes: '$ Toe0' },
    fingers: fingersBy((finger) => `$ Finger${fingerNames.indexOf(finger)}#`),
  },
  VRM: {
    ...sides,
    centre: { hips: 'hips', spine: 'spine', chest: 'chest', upperChest: 'upperChest', neck: 'neck', head: 'head' },
    sides: {
      ...{ Shoulder: '$Shoulder', UpperArm: '$UpperArm', LowerArm: '$LowerArm', Hand: '$Hand', Eye: '$Eye' },
      ...{ UpperLeg: '$UpperLeg', LowerLeg: '$LowerLeg', Foot: '$Foot', Toes: '$Toes' },
    },
    fingers: fingersBy(() => '$%'),
  },
};

/** Returns a form that all spellings of one name share. */
const plain = (name: string): string => name.toLowerCase().replace(/[^a-z0-9]/g, '');

/** Each bone that a naming calls by name, as `plain` writes it. */
function bonesOf({ centre, sides: names, left, right, fingers }: Naming): ReadonlyMap<BoneName, string> {
  const bones = new Map<BoneName, string>();
  for (const [bone, called] of Object.entries(centre)) bones.set(bone as BoneName, plain(called));
  for (const [side, sign] of [
    ['left', left],
    ['right', right],
  ] as const) {
    for (const [bone, called] of Object.entries(names)) {
      bones.set(`${side}${bone}` as BoneName, plain(called.replace('$', sign)));
    }
    for (const finger of fingerNames) {
      for (const [index, bone] of fingerBones(finger).entries()) {
        // Biped counts fingers from 0 and leaves the first phalanx without a number.
        const form = fingers[finger].replace('$', sign);
        const number = form.includes('Finger') ? (index === 0 ? '' : String(index)) : String(index + 1);
        bones.set(`${side}${bone}` as BoneName, plain(form.replace('#', number).replace('%', bone)));
      }
    }
  }
  return bones;
}

const tables = Object.values(namings).map(bonesOf);
/** Every bone that a map may name. */
export const boneNames: ReadonlySet<string> = new Set(tables.flatMap((table) => [...table.keys()]));
/** What people call the namings of `bonesByName`, for a sentence. */
export const knownNamings: readonly string[] = Object.keys(namings);

/** Nodes by the name that `read` makes of theirs; of several the first, which is the uppermost. */
function byName(names: readonly string[], read: (name: string) => string): Map<string, string> {
  const found = new Map<string, string>();
  for (const name of names) {
    const key = read(name);
    if (key !== '' && !found.has(key)) found.set(key, name);
  }
  return found;
}

/**
 * What stands before every bone's name in a file: each thing that stands before the hips' (`mixamorig:`, `DEF-`,
 * `J_Bip_`, `CC_Base_`).
 */
function prefixesOf(names: Iterable<string>, hips: string): Set<string> {
  const prefixes = new Set<string>();
  for (const name of names) if (name.endsWith(hips)) prefixes.add(name.slice(0, -hips.length));
  return prefixes;
}

/**
 * Which nodes are a body's bones, by their names alone, under any prefix: the naming that finds the most. Empty where
 * no naming finds hips and a head. Names with a number at the end, as Sketchfab writes them (`mixamorig:Hips_01`), are
 * read without it where that finds more.
 */
export function bonesByName(nodeNames: readonly string[]): BoneMap {
  let best: BoneMap = {};
  const readings = [plain, (name: string) => plain(name.replace(/_\d+$/, ''))];
  for (const read of readings) {
    const found = byName(nodeNames, read);
    for (const table of tables) {
      for (const prefix of prefixesOf(found.keys(), table.get('hips') ?? '')) {
        const bones: Partial<Record<BoneName, string>> = {};
        for (const [bone, called] of table) {
          const node = found.get(prefix + called);
          if (node !== undefined) bones[bone] = node;
        }
        if (bones.head !== undefined && Object.keys(bones).length > Object.keys(best).length) best = bones;
      }
    }
  }
  return best;
}
