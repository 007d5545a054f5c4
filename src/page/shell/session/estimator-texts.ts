import type { EstimatorName } from 'threepoint/core';

/**
 * The label of each estimator on the page and what it does, in one line, in the order in which they are offered: best
 * first, then what needs more than three points.
 */
export const estimatorTexts: Readonly<Record<EstimatorName, { readonly label: string; readonly text: string }>> = {
  learned: { label: 'Learned', text: 'The most lifelike: learned from recordings of people.' },
  ik: { label: 'Inverse kinematics', text: 'Calculated from how joints bend, without learning.' },
  paper: { label: 'Paper', text: 'For comparison: as in the study of Anvari, Park and Kim (2023).' },
  'hands-only': { label: 'Hands only', text: 'Head and hands, and nothing between them.' },
  device: {
    label: 'Device',
    text: 'The body that the headset tracks itself; without one, Learned.',
  },
};

/** The order in which they are offered. */
export const estimatorOrder = Object.keys(estimatorTexts) as readonly EstimatorName[];
