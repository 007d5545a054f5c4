/** A joint of the person that the made files have: name, parent, offset in T-pose facing +Z [cm]. */
type Bone = readonly [name: string, parent: string | null, offset: readonly [number, number, number]];

const side = (sign: number, word: string): readonly Bone[] => [
  [`${word}Shoulder`, 'Spine1', [3 * sign, 20, 0]],
  [`${word}Arm`, `${word}Shoulder`, [14 * sign, 0, 0]],
  [`${word}ForeArm`, `${word}Arm`, [28 * sign, 0, 0]],
  [`${word}Hand`, `${word}ForeArm`, [25 * sign, 0, 0]],
  [`${word}UpLeg`, 'Hips', [9 * sign, -5, 0]],
  [`${word}Leg`, `${word}UpLeg`, [0, -42, 0]],
  [`${word}Foot`, `${word}Leg`, [0, -41, 0]],
  [`${word}Toe`, `${word}Foot`, [0, -6, 12]],
];
const bones: readonly Bone[] = [
  ['Hips', null, [0, 95, 0]],
  ['Spine', 'Hips', [0, 10, 0]],
  ['Spine1', 'Spine', [0, 15, 0]],
  ['Neck', 'Spine1', [0, 25, 0]],
  ['Head', 'Neck', [0, 10, 1]],
  ...side(1, 'Left'),
  ...side(-1, 'Right'),
];

const fingerBase = (word: string): readonly Bone[] => [
  [`${word}FingerBase`, `${word}Hand`, [0, 0, 0]],
  [`${word[0]}Thumb`, `${word}Hand`, [0, 0, 0]],
];
const cmuBones: readonly Bone[] = [
  ...bones.map(([name, parent, offset]): Bone => {
    if (name === 'Spine') return [name, 'LowerBack', [0, 10, 0]];
    return [name, parent, /^(Neck|LeftShoulder|RightShoulder)$/.test(name) ? [0, 0, 0] : offset];
  }),
  ['LowerBack', 'Hips', [0, 0, 0]],
  ...fingerBase('Left'),
  ...fingerBase('Right'),
];

const add = (a: Bone[2], b: Bone[2], sign: number): Bone[2] => [
  a[0] + sign * b[0],
  a[1] + sign * b[1],
  a[2] + sign * b[2],
];
const trunk = bones.slice(0, 5);
/** The trunk from the head down, as programs of body trackers write it. */
const hungFromHead: readonly Bone[] = [
  ['Head', null, trunk.reduce<Bone[2]>((sum, [, , offset]) => add(sum, offset, 1), [0, 0, 0])],
  ...trunk
    .slice(1)
    .map(([name, parent, offset]): Bone => [parent!, name, add([0, 0, 0], offset, -1)])
    .reverse(),
  ...bones.slice(5),
];

/** Angles about Z, X and Y [degrees] at a time [s]: one arm hangs, the other waves. */
function anglesAt(name: string, time: number): readonly [number, number, number] {
  if (name === 'LeftArm') return [-75, 0, 0];
  if (name === 'RightArm') return [20, 0, 0];
  if (name === 'RightForeArm') return [-70 + 25 * Math.sin(2 * Math.PI * time), 0, 0];
  return [0, 0, 0];
}

/** Angles about Z, X and Y [degrees] of a person who walks at 1.3 m/s, looks around and nods. */
export function walkingAnglesAt(name: string, time: number): readonly [number, number, number] {
  const sign = name.startsWith('Left') ? 1 : -1;
  const swing = sign * Math.sin(2 * Math.PI * time);
  const part = name.replace(/^(Left|Right)/, '');
  const angles: Readonly<Record<string, readonly [number, number, number]>> = {
    ...{ UpLeg: [0, -8 - 22 * swing, 0], Leg: [0, 25 + 20 * Math.cos(2 * Math.PI * time + sign), 0] },
    ...{ Arm: [sign * -75, 0, sign * 18 * swing], ForeArm: [0, 0, sign * (-35 + 12 * swing)] },
    ...{ Hand: [sign * 6 * swing, 0, 0], Spine1: [0, 3, 4 * Math.sin(2 * Math.PI * time)] },
    Head: [0, 9 * Math.sin(5 * time), 12 * Math.sin(3 * time)],
  };
  return angles[part] ?? [0, 0, 0];
}

export interface MadeOptions {
  readonly nameOf?: (name: string) => string;
  /** Every joint has six channels; its positions are those of `positionOf`. */
  readonly positionOf?: (offset: Bone[2], name: string) => Bone[2];
  readonly numberOf?: (value: number) => string;
  /** The frame's motion is turned: a program turned the root alone. */
  readonly rootZUp?: boolean;
  /** The place of the root in every frame [cm]. */
  readonly rootPlace?: Bone[2];
  /** Changes offsets and axes of the rest alone. */
  readonly offsetOf?: (offset: Bone[2], name: string) => Bone[2];
  /** Lengths of the file per centimetre. */
  readonly unit?: number;
  readonly without?: readonly string[];
  /** The skeleton as cmuconvert writes it of the CMU database: thorax and wrists have no length. */
  readonly cmuconvert?: boolean;
  /** The head is the root. */
  readonly fromHead?: boolean;
  /** Angles about Z, X and Y of joints that move in another way [degrees]. */
  readonly anglesOf?: Readonly<Record<string, readonly [number, number, number]>>;
  /** The angles of all other joints at a time [s]; absent: one arm hangs, the other waves. */
  readonly anglesAt?: (name: string, time: number) => readonly [number, number, number];
  /** The speed of the root along +Z [cm/s]. */
  readonly speed?: number;
  /** The number of frames at 60 Hz (60). */
  readonly frames?: number;
}

const plainNumber = (value: number): string => value.toFixed(4);

/** A BVH of one person of 1.70 m who waves for a second, in the form that the options describe. */
export function madeBvh(options: MadeOptions = {}): string {
  const {
    nameOf = (name) => name,
    numberOf = plainNumber,
    unit = 1,
    without = [],
    frames: count = 60,
    speed = 0,
  } = options;
  const offsetOf = options.offsetOf ?? ((offset) => offset);
  const ofOptions = options.fromHead ? hungFromHead : options.cmuconvert ? cmuBones : bones;
  const kept = ofOptions.filter(([name]) => !without.includes(name));
  const row = (values: readonly number[]) => values.map(numberOf).join(' ');
  const lengths = (values: readonly number[]) => values.map((value) => value * unit);
  const order: Bone[] = [];
  const lines = (bone: Bone, depth: number): string[] => {
    const [name, parent, offset] = bone;
    order.push(bone);
    const tab = '\t'.repeat(depth);
    const children = kept.filter(([, of]) => of === name);
    const six = parent === null || options.positionOf !== undefined;
    return [
      `${tab}${parent === null ? 'ROOT' : 'JOINT'} ${nameOf(name)}`,
      `${tab}{`,
      `${tab}\tOFFSET ${row(lengths(parent === null ? [0, 0, 0] : offsetOf(offset, name)))}`,
      `${tab}\tCHANNELS ${six ? '6 Xposition Yposition Zposition ' : '3 '}Zrotation Xrotation Yrotation`,
      ...children.flatMap((child) => lines(child, depth + 1)),
      ...(children.length === 0
        ? [`${tab}\tEnd Site`, `${tab}\t{`, `${tab}\t\tOFFSET ${row(lengths([0, 8, 0]))}`, `${tab}\t}`]
        : []),
      `${tab}}`,
    ];
  };
  const hierarchy = lines(kept[0]!, 0);
  const frames = Array.from({ length: count }, (_, frame) =>
    row(
      order.flatMap(([name, parent, offset]) => {
        const [z, x, y] = options.anglesOf?.[name] ?? (options.anglesAt ?? anglesAt)(name, frame / 60);
        const turned = parent === null && options.rootZUp === true;
        const root = turned ? [offset[0], -offset[2], offset[1]] : offset;
        const [rootX, rootY, rootZ] = options.rootPlace ?? root;
        const moved = [rootX!, rootY!, rootZ! + (speed * frame) / 60];
        const place = parent === null ? moved : options.positionOf?.(offset, name);
        return [...lengths(place ?? []), z, turned ? x + 90 : x, y];
      }),
    ),
  );
  return [
    'HIERARCHY',
    ...hierarchy,
    'MOTION',
    `Frames: ${count}`,
    `Frame Time: ${numberOf(1 / 60)}`,
    ...frames,
    '',
  ].join('\n');
}
