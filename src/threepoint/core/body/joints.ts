/**
 * Joints of the upper body, by their VRM humanoid names, parents before children. A joint is its bone's origin:
 * `leftLowerArm` is the elbow, `leftHand` the wrist. The paper's shoulder is `UpperArm` here; its "spine" is `chest`,
 * where the thorax segment begins; its "pelvis" is `hips`.
 */
export const jointNames = [
  'hips',
  'spine',
  'chest',
  'upperChest',
  'neck',
  'head',
  'leftShoulder',
  'leftUpperArm',
  'leftLowerArm',
  'leftHand',
  'rightShoulder',
  'rightUpperArm',
  'rightLowerArm',
  'rightHand',
] as const;

export type JointName = (typeof jointNames)[number];

/** The parent of each joint; `hips` is the root. */
export const parentOf: Readonly<Record<JointName, JointName | null>> = {
  hips: null,
  spine: 'hips',
  chest: 'spine',
  upperChest: 'chest',
  neck: 'upperChest',
  head: 'neck',
  leftShoulder: 'upperChest',
  leftUpperArm: 'leftShoulder',
  leftLowerArm: 'leftUpperArm',
  leftHand: 'leftLowerArm',
  rightShoulder: 'upperChest',
  rightUpperArm: 'rightShoulder',
  rightLowerArm: 'rightUpperArm',
  rightHand: 'rightLowerArm',
};

/**
 * The six joints that no device tracks, which the networks estimate and the tables report, in the order of every
 * tensor.
 */
export const estimatedJoints = [
  'leftLowerArm',
  'rightLowerArm',
  'leftUpperArm',
  'rightUpperArm',
  'chest',
  'hips',
] as const satisfies readonly JointName[];

export type EstimatedJoint = (typeof estimatedJoints)[number];
