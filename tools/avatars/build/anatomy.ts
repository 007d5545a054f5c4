import { fingerBoneSuffixes } from 'threepoint/core';
import type { BodyRig } from './rig';
import {
  boxOf,
  type DistanceField,
  distanceToBox,
  ellipsoid,
  moved,
  type Point,
  roundedBox,
  type Solid,
  smoothUnion,
  taperedCapsule,
} from './signed-distance';

/** A piece of the body: a solid, the bone it moves with and how softly its weight fades beyond its surface [m]. */
export interface Part {
  readonly solid: Solid;
  /** A bone of the left side or the trunk; `trunk`: shared among the spine by height. */
  readonly bone: string;
  readonly softness: number;
}

export interface Region {
  readonly parts: readonly Part[];
  /** Fillet between its own parts, and where it meets what came before [m]. */
  readonly inner: number;
  readonly joint: number;
}

/** A body to be meshed. */
export interface Anatomy {
  readonly rig: BodyRig;
  readonly parts: readonly Part[];
  readonly body: DistanceField;
}

export const part = (bone: string, softness: number, solid: Solid): Part => ({ bone, softness, solid });

const each = (region: Region, change: (part: Part) => Part): Region => ({ ...region, parts: region.parts.map(change) });

/** Moves a region, or scales it about a point. */
export const movedRegion = (region: Region, move: Parameters<typeof moved>[1]): Region =>
  each(region, (one) => ({ ...one, solid: moved(one.solid, move) }));

/**
 * What lies on the clavicle of shoulder joints so far out of the middle [m]: the trapezius, which slopes by some 20°
 * from the neck down to the acromion, and the muscles before it; so thick against the mannequin's. The acromion's skin
 * is 4 cm above the joint: a hanging arm then lies under it.
 */
export const shoulderGirdle = (shoulder: number, thick: number): Part[] => [
  part(
    'trunk',
    0.02,
    taperedCapsule([0.02, 1.446, -0.03], [shoulder - 0.034, 1.383, -0.018], 0.047 * thick, 0.031 * thick),
  ),
  part(
    'trunk',
    0.02,
    taperedCapsule([0.03, 1.375, 0.02], [shoulder - 0.051, 1.374, 0.006], 0.045 * thick, 0.037 * thick),
  ),
];

export const mannequinTorso: Region = {
  inner: 0.055,
  joint: 0.05,
  parts: [
    // Ribcage, waist and pelvis are the masses; chest, back and seat muscles lie on them.
    part('trunk', 0.02, ellipsoid([0, 1.255, -0.008], [0.142, 0.185, 0.098])),
    part('trunk', 0.02, ellipsoid([0, 1.1, 0], [0.127, 0.15, 0.088])),
    part('trunk', 0.02, ellipsoid([0, 0.975, -0.004], [0.143, 0.105, 0.094])),
    part('trunk', 0.02, ellipsoid([0.07, 1.305, 0.043], [0.085, 0.066, 0.038], 0.2)),
    part('trunk', 0.02, ellipsoid([0.1, 1.24, -0.048], [0.058, 0.13, 0.048])),
    ...shoulderGirdle(0.181, 1),
    part('trunk', 0.02, ellipsoid([0.072, 0.93, -0.046], [0.074, 0.085, 0.062])),
  ],
};

export const averageNeck: Region = {
  inner: 0.02,
  joint: 0.045,
  parts: [
    part('neck', 0.016, taperedCapsule([0, 1.42, -0.016], [0, 1.535, -0.002], 0.054, 0.05)),
    part('neck', 0.016, taperedCapsule([0.028, 1.405, 0.028], [0.05, 1.53, -0.012], 0.014, 0.018)),
  ],
};

export const averageHead: Region = {
  inner: 0.03,
  joint: 0.022,
  parts: [
    part('head', 0.02, ellipsoid([0, 1.613, -0.012], [0.0735, 0.087, 0.091])),
    part('head', 0.02, ellipsoid([0, 1.572, 0.024], [0.06, 0.074, 0.064])),
    part('head', 0.02, taperedCapsule([0, 1.516, 0.05], [0.018, 1.512, 0.044], 0.026, 0.026)),
    part('head', 0.02, taperedCapsule([0.052, 1.553, -0.002], [0.026, 1.51, 0.036], 0.017, 0.02)),
    part('head', 0.02, taperedCapsule([0.006, 1.622, 0.072], [0.042, 1.618, 0.058], 0.011, 0.009)),
    part('head', 0.02, taperedCapsule([0.034, 1.574, 0.052], [0.052, 1.58, 0.03], 0.02, 0.018)),
  ],
};

export const averageFace: Region = {
  inner: 0.008,
  joint: 0.014,
  parts: [
    part('head', 0.02, taperedCapsule([0, 1.605, 0.084], [0, 1.57, 0.098], 0.006, 0.0105)),
    part('head', 0.02, ellipsoid([0.013, 1.567, 0.087], [0.008, 0.007, 0.009])),
    part('head', 0.02, taperedCapsule([0, 1.541, 0.081], [0.016, 1.541, 0.073], 0.0072, 0.005)),
    part('head', 0.02, taperedCapsule([0, 1.531, 0.0795], [0.013, 1.532, 0.073], 0.0072, 0.005)),
  ],
};

export const averageEars: Region = {
  inner: 0.006,
  joint: 0.01,
  parts: [part('head', 0.02, ellipsoid([0.0745, 1.582, -0.012], [0.009, 0.028, 0.016], -0.25))],
};

/** How thick limbs are against the mannequin's. */
export interface Girths {
  readonly shoulder: number;
  readonly upperArm: number;
  readonly forearm: number;
  readonly thigh: number;
  readonly calf: number;
}

export const averageGirths: Girths = { shoulder: 1, upperArm: 1, forearm: 1, thigh: 1, calf: 1 };

/** Arm and palm are modelled about z = 0 and put where the shoulder is. */
const onArm = (region: Region, { armDepth }: BodyRig): Region => movedRegion(region, { by: [0, 0, armDepth] });

export function armOf(rig: BodyRig, { shoulder: d, upperArm: u, forearm: f }: Girths): Region {
  const { armHeight: y } = rig;
  const { shoulder, elbow, wrist } = rig.armJoints;
  // What is more of a thick arm lies under it.
  const sag = 0.03 * Math.max(0, u - 1);
  return onArm(
    {
      inner: 0.028,
      joint: 0.06,
      parts: [
        part('leftUpperArm', 0.018, ellipsoid([shoulder + 0.012, y - 0.014, 0.004], [0.064 * d, 0.048 * d, 0.054 * d])),
        part(
          'leftUpperArm',
          0.016,
          taperedCapsule([shoulder + 0.02, y - 0.008 - sag, 0], [elbow - 0.02, y, 0], 0.042 * u, 0.034 * u),
        ),
        part('leftUpperArm', 0.016, ellipsoid([shoulder + 0.14, y - sag, 0.016], [0.085, 0.035 * u, 0.034 * u])),
        part(
          'leftUpperArm',
          0.016,
          ellipsoid([shoulder + 0.14, y + 0.002 - sag, -0.018], [0.095, 0.036 * u, 0.032 * u]),
        ),
        // The olecranon: what an elbow that is bent is pointed by.
        part('leftLowerArm', 0.016, ellipsoid([elbow + 0.004, y, -0.024 * f], [0.022, 0.017 * f, 0.0175 * f])),
        part('leftLowerArm', 0.016, taperedCapsule([elbow, y, 0], [wrist - 0.01, y, -0.002], 0.0365 * f, 0.0225 * f)),
        part('leftLowerArm', 0.016, ellipsoid([elbow + 0.075, y + 0.003, 0.008], [0.085, 0.034 * f, 0.036 * f])),
        part('leftLowerArm', 0.016, ellipsoid([elbow + 0.08, y - 0.002, -0.018], [0.09, 0.034 * f, 0.03 * f])),
        part('leftLowerArm', 0.012, ellipsoid([wrist - 0.03, y, -0.001], [0.05, 0.0205 * f, 0.0275 * f])),
      ],
    },
    rig,
  );
}

/** A palm so large against the average one. */
export function palmOf(rig: BodyRig, size: number): Region {
  const { armHeight: y, fingers } = rig;
  const { wrist } = rig.armJoints;
  const about: Point = [wrist, y, 0];
  const palm: Region = {
    inner: 0.014,
    joint: 0.018,
    parts: [
      part('leftHand', 0.009, roundedBox([wrist + 0.05, y - 0.001, 0], [0.046, 0.0145, 0.037], 0.0135)),
      part('leftHand', 0.009, taperedCapsule([wrist + 0.004, y, -0.001], [wrist + 0.03, y, 0], 0.021, 0.022)),
      part('leftHand', 0.009, ellipsoid([wrist + 0.038, y - 0.009, 0.02], [0.032, 0.015, 0.019])),
      part('leftHand', 0.009, ellipsoid([wrist + 0.045, y - 0.009, -0.026], [0.034, 0.013, 0.014])),
    ],
  };
  const knuckles = fingers
    .filter(({ name }) => name !== 'Thumb')
    .map(({ knuckle, radius }) =>
      part(
        'leftHand',
        0.007,
        taperedCapsule([wrist + 0.04 * size, y, knuckle[2] * 0.8], knuckle, 0.012 * size, radius * 1.12),
      ),
    );
  const larger = size === 1 ? palm : movedRegion(palm, { about, factor: [size, size, size] });
  return onArm({ ...larger, parts: [...larger.parts, ...knuckles] }, rig);
}

export const fingersOf = ({ fingers, fingerPoint }: BodyRig): Region[] =>
  fingers.map((finger) => {
    const names = fingerBoneSuffixes(finger.name);
    const segment = (index: number): Part => {
      const from = fingerPoint(finger, index);
      const to = fingerPoint(finger, index + 1);
      const radius = (step: number) => finger.radius * (1 - 0.085 * step);
      const tip: Point =
        index < 2
          ? to
          : [
              to[0] - finger.direction[0] * 0.006,
              to[1] - finger.direction[1] * 0.006,
              to[2] - finger.direction[2] * 0.006,
            ];
      return part(`left${names[index]}`, 0.0035, taperedCapsule(from, tip, radius(index), radius(index + 1)));
    };
    return {
      inner: 0.004,
      joint: finger.name === 'Thumb' ? 0.016 : 0.008,
      parts: [segment(0), segment(1), segment(2)],
    };
  });

const mannequinLeg: Region = {
  inner: 0.05,
  joint: 0.06,
  parts: [
    part('leftUpperLeg', 0.022, taperedCapsule([0.088, 0.9, -0.004], [0.096, 0.53, 0.002], 0.082, 0.052)),
    part('leftUpperLeg', 0.022, ellipsoid([0.098, 0.74, 0.02], [0.064, 0.17, 0.056])),
    part('leftUpperLeg', 0.022, ellipsoid([0.092, 0.76, -0.03], [0.06, 0.16, 0.05])),
    part('leftLowerLeg', 0.02, ellipsoid([0.096, 0.5, 0.012], [0.049, 0.055, 0.048])),
    part('leftLowerLeg', 0.02, taperedCapsule([0.096, 0.47, 0], [0.098, 0.1, -0.02], 0.048, 0.032)),
    part('leftLowerLeg', 0.02, ellipsoid([0.097, 0.36, -0.026], [0.05, 0.115, 0.046])),
  ],
};

/** A leg whose shape shows through trousers: narrow at the knee, whose cap lies ahead, with a full calf behind. */
export const legOf = ({ thigh: t, calf: c }: Girths): Region => ({
  inner: 0.04,
  joint: 0.06,
  parts: [
    part('leftUpperLeg', 0.022, taperedCapsule([0.088, 0.9, -0.004], [0.097, 0.53, 0.002], 0.084 * t, 0.046 * t)),
    part('leftUpperLeg', 0.022, ellipsoid([0.1, 0.75, 0.022], [0.067 * t, 0.165, 0.058 * t])),
    part('leftUpperLeg', 0.022, ellipsoid([0.092, 0.77, -0.034], [0.062 * t, 0.15, 0.052 * t])),
    part('leftLowerLeg', 0.018, ellipsoid([0.097, 0.505, 0.022], [0.038 * c, 0.042, 0.035 * c])),
    part('leftLowerLeg', 0.018, taperedCapsule([0.097, 0.49, 0.001], [0.099, 0.1, -0.02], 0.043 * c, 0.031 * c)),
    part('leftLowerLeg', 0.018, ellipsoid([0.104, 0.365, -0.033], [0.045 * c, 0.1, 0.044 * c])),
    part('leftLowerLeg', 0.018, ellipsoid([0.088, 0.345, -0.03], [0.04 * c, 0.095, 0.042 * c])),
  ],
});

export const averageFoot: Region = {
  inner: 0.03,
  joint: 0.035,
  parts: [
    part('leftFoot', 0.014, ellipsoid([0.098, 0.042, -0.034], [0.036, 0.05, 0.04])),
    part('leftFoot', 0.014, taperedCapsule([0.099, 0.07, -0.006], [0.103, 0.03, 0.1], 0.04, 0.03)),
    part('leftToes', 0.014, ellipsoid([0.106, 0.022, 0.135], [0.042, 0.024, 0.052])),
    part('leftFoot', 0.014, ellipsoid([0.104, 0.022, 0.075], [0.04, 0.026, 0.06])),
  ],
};

/** Both halves of the body meet without a crease: |x|, rounded within a centimetre of the middle. */
export const foldedX = (x: number): number => Math.sqrt(x * x + 0.006 * 0.006);

/** Further from a region than this its field is the distance to its box [m]: no fillet reaches so far. */
const far = 0.12;

/** The field of a region's own parts, x ≥ 0. */
export function fieldOf({ parts, inner }: Region): DistanceField {
  const { min, max } = boxOf(parts.map(({ solid }) => solid));
  return (x, y, z) => {
    const away = distanceToBox(x, y, z, min, max);
    if (away > far) return away;
    let own = 1;
    for (const { solid } of parts) own = smoothUnion(own, solid.distance(x, y, z), inner);
    return own;
  };
}

/** Regions joined one after the other, x ≥ 0. */
export function joined(regions: readonly Region[]): DistanceField {
  const fields = regions.map((region) => ({ field: fieldOf(region), joint: region.joint }));
  return (x, y, z) => {
    let distance = 1;
    for (const { field, joint } of fields) distance = smoothUnion(distance, field(x, y, z), joint);
    return distance;
  };
}

/** The soles: a flat cut at the floor with a rounded edge. */
export const onFloor = (distance: number, y: number): number => -smoothUnion(-distance, y, 0.012);

/** The mannequin, cut flat at the floor. */
export function mannequinAnatomy(rig: BodyRig): Anatomy {
  const regions = [
    mannequinTorso,
    averageNeck,
    averageHead,
    averageFace,
    averageEars,
    mannequinLeg,
    averageFoot,
    armOf(rig, averageGirths),
    palmOf(rig, 1),
    ...fingersOf(rig),
  ];
  const whole = joined(regions);
  return {
    rig,
    parts: regions.flatMap(({ parts }) => parts),
    body: (x, y, z) => onFloor(whole(foldedX(x), y, z), y),
  };
}
