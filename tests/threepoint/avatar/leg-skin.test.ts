import { describe, expect, test } from 'vitest';
import { defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { trackerAtJoint } from '../../../src/threepoint/core/body/tracker-offsets';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { pinning } from '../../../src/threepoint/core/estimation/pinning';
import { postures, trackedPostures } from '../../../tools/avatars/try/postures';
import { printFigures } from '../../print-figures';
import { builtInBody } from './drawn-skin';
import { type Crossing, cut, radiiOf } from './skin-cuts';

const trackerOffsets = { hips: trackerAtJoint, leftFoot: trackerAtJoint, rightFoot: trackerAtJoint };

async function wearer(name: string) {
  const avatar = await builtInBody(name);
  avatar.setCalibration(defaultCalibration);
  const estimator = createIk({ ...defaultCalibration, trackerOffsets }, { pinning });
  let time = 0;
  const show = (posture: string) => {
    const { frame } = [...postures, ...trackedPostures].find((one) => one.name === posture)!;
    for (let i = 0; i < 12; i++) {
      time += 1 / 30;
      avatar.setPose(estimator.update({ ...frame, time }).pose, time);
    }
    avatar.object.updateMatrixWorld(true);
  };
  show('T-pose');
  const { leftUpperLeg, leftLowerLeg } = avatar.jointPositions();
  const [hip, knee] = [leftUpperLeg!, leftLowerLeg!];
  /** Cuts across the left leg by level planes from so far above a joint to so far below it [m]. */
  const about = (joint: { readonly y: number }, range: number): Crossing[][] =>
    Array.from({ length: 7 }, (_, i) => {
      const height = joint.y + range * (i / 3 - 1);
      return cut(avatar, ({ x, y }) => (x < -0.03 && x > -0.25 ? y - height : null));
    });
  const rest = (cuts: readonly Crossing[][]) => cuts.map((crossings) => ({ crossings, rest: radiiOf(crossings) }));
  const parts = { hip: rest(about(hip, 0.04)), knee: rest(about(knee, 0.04)) };
  /** The thinnest cut about a joint against itself at rest, by its mean radius. */
  const thinnest = (part: keyof typeof parts) =>
    Math.min(...parts[part].map(({ crossings, rest }) => radiiOf(crossings).mean / rest.mean));
  return { avatar, show, thinnest };
}

describe.each(['mannequin', 'woman', 'man', 'stout', 'child'])('the legs of the %s', (name) => {
  test('keep their girth at hip and knee, sitting, squatting low, and with a raised knee', async () => {
    const { avatar, show, thinnest } = await wearer(name);
    for (const posture of ['sitting', 'deep squat', 'knee raised']) {
      show(posture);
      const [hip, knee] = [thinnest('hip'), thinnest('knee')];
      printFigures(`${name}, ${posture} [share of the radius]`, { hip: hip.toFixed(3), knee: knee.toFixed(3) });
      expect(hip).toBeGreaterThan(0.85);
      expect(knee).toBeGreaterThan(0.85);
    }
    avatar.dispose();
  });
});
