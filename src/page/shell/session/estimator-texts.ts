import type { EstimatorName } from 'threepoint/core';

interface EstimatorText {
  readonly label: string;
  /** What it does, in one sentence for visitors. */
  readonly text: string;
  /** What exactly it does, in one sentence for researchers; docs/estimation.md has the rest. */
  readonly details: string;
}

/** The texts of each estimator, in the order of lists. */
export const estimatorTexts: Readonly<Record<EstimatorName, EstimatorText>> = {
  learned: {
    label: 'Learned',
    text: 'The most lifelike: learned from recordings of people.',
    details:
      'A network that was trained on motion capture corrects the six joints of inverse kinematics, along its chest’s axes.',
  },
  ik: {
    label: 'Inverse kinematics',
    text: 'Calculated from how joints bend, without learning.',
    details: 'Six joints in closed form from head and hands; then bones of constant length are fitted to them.',
  },
  paper: {
    label: 'Paper',
    text: 'For comparison: as in the study of Anvari, Park and Kim (2023).',
    details: 'The paper’s network estimates six joints from the positions and Euler angles of one frame.',
  },
  'paper-published': {
    label: 'Paper as published',
    text: 'For comparison: the whole method of Anvari, Park and Kim (2023).',
    details: 'The joints of Paper, with the orientations of the paper’s section 3.5: no fit, no filters.',
  },
  'hands-only': {
    label: 'Hands only',
    text: 'Head and hands, and nothing between them.',
    details: 'The tracked poses alone: no joint is estimated, and no body is drawn.',
  },
  device: {
    label: 'Device',
    text: 'The body that the headset tracks itself; without one, Learned.',
    details:
      'Six joints of WebXR body tracking, while its head is within 0.3 m and its wrists are within 0.2 m of the tracked ones.',
  },
};

/** All estimators, in the order in which lists show them. */
export const listedEstimators = Object.keys(estimatorTexts) as readonly EstimatorName[];
