import type { EstimatorName } from 'threepoint/core';

/**
 * The label of each estimator on the page and what it does, in one line, in the order in which they are offered: best
 * first, then what needs more than three points.
 */
export const estimatorTexts: Readonly<Record<EstimatorName, { readonly label: string; readonly text: string }>> = {
  learned: { label: 'Learned', text: 'A network trained on motion capture corrects the IK body.' },
  ik: { label: 'Inverse kinematics', text: 'Spine, clavicles and elbows in closed form.' },
  paper: { label: 'Paper', text: 'The network of Anvari, Park and Kim (2023), as published.' },
  'hands-only': { label: 'Hands only', text: 'Head and hands as tracked, no body between them.' },
  device: {
    label: 'Device',
    text: 'The body that the headset itself tracks. Learned replaces it when the headset reports none.',
  },
};

/** The order in which they are offered. */
export const estimatorOrder = Object.keys(estimatorTexts) as readonly EstimatorName[];
