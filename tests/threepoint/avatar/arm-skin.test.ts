import { SkinnedMesh, Vector3 } from 'three';
import { beforeAll, describe, expect, test } from 'vitest';
import { createAvatar } from '../../../src/threepoint/avatar/avatar';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { type AvatarPose, makeUpperBodyPose } from '../../../src/threepoint/core/body/avatar-pose';
import { defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { skeletonFromCalibration } from '../../../src/threepoint/core/body/skeleton';
import { makePose } from '../../../src/threepoint/core/math/pose';
import { copyQuat, fromAxisAngle, multiply, type Quat, quat } from '../../../src/threepoint/core/math/quat';
import { down, forward, type Vec3, vec3 } from '../../../src/threepoint/core/math/vec3';
import { printFigures } from '../../print-figures';
import { builtInFile } from './drawn-skin';
import { mannequin } from './glb';
import { type Crossing, cut, placeOf, radiiOf } from './skin-cuts';

const along = vec3(-1, 0, 0);
const radians = (degrees: number) => (degrees * Math.PI) / 180;

/** How the left arm and the head are turned from T-pose [degrees]. */
interface Turn {
  /** The swing of the whole arm about an axis of the chest. */
  readonly swing?: { readonly axis: Vec3; readonly angle: number };
  /** The roll of the upper arm about itself. */
  readonly upperRoll?: number;
  readonly elbow?: number;
  /** The bend of the hand towards its palm. */
  readonly wrist?: number;
  /** The head's turn to the left and bend forward; the neck takes half of each. */
  readonly headTurn?: number;
  readonly headBend?: number;
  /** The roll of the hand about the forearm; the estimators give half of it to the forearm's bone. */
  readonly roll?: number;
}

function poseOf({
  swing,
  upperRoll = 0,
  elbow = 0,
  wrist = 0,
  headTurn = 0,
  headBend = 0,
  roll = 0,
}: Turn): AvatarPose {
  const body = makeUpperBodyPose();
  const { restOffsets } = skeletonFromCalibration(defaultCalibration);
  Object.assign(body.hipsPosition, restOffsets.hips);
  const half = fromAxisAngle(along, radians(roll) / 2);
  const turn = (joint: 'leftUpperArm' | 'leftLowerArm' | 'leftHand' | 'neck' | 'head', q: Quat) =>
    copyQuat(q, body.localRotations[joint]);
  const swung = swing ? fromAxisAngle(swing.axis, radians(swing.angle)) : quat(0, 0, 0, 1);
  turn('leftUpperArm', multiply(swung, fromAxisAngle(along, radians(upperRoll))));
  turn('leftLowerArm', multiply(fromAxisAngle(down, radians(elbow)), half));
  turn('leftHand', multiply(half, fromAxisAngle(forward, radians(-wrist))));
  const halfway = multiply(fromAxisAngle(down, radians(-headTurn) / 2), fromAxisAngle(along, radians(headBend) / 2));
  turn('neck', halfway);
  turn('head', halfway);
  return { head: { ...makePose<'floor'>(), tracking: 'tracked' }, leftHand: null, rightHand: null, body };
}

async function wearer(file: ArrayBuffer) {
  const avatar = createAvatar(await parseAvatar(file, 'test.glb'));
  avatar.setCalibration(defaultCalibration);
  let time = 0;
  const show = (turn: Turn) => {
    time += 0.1;
    avatar.setPose(poseOf(turn), time);
    avatar.object.updateMatrixWorld(true);
  };
  show({});
  const { leftUpperArm, leftLowerArm, leftHand, neck: neckJoint } = avatar.jointPositions();
  const place = ({ x, y, z }: Vec3) => new Vector3(x, y, z);
  const [shoulder, elbow, wrist] = [place(leftUpperArm!), place(leftLowerArm!), place(leftHand!)];
  /** A cut across the arm, so far from one place to another [share of the way]. */
  const across = (from: Vector3, to: Vector3, share: number): Crossing[] => {
    const way = to.clone().sub(from);
    return cut(avatar, (vertex) => {
      const ahead = vertex.clone().sub(from);
      const height = ahead.dot(way) / way.lengthSq() - share;
      // Only vertices of this arm count, not those of the hand's thumb.
      return ahead.addScaledVector(way, -(height + share)).length() < 0.12 ? height : null;
    });
  };
  const rests = (cuts: readonly Crossing[][]) => cuts.map((crossings) => ({ crossings, rest: radiiOf(crossings) }));
  const shares = (first: number, last: number) =>
    Array.from({ length: 12 }, (_, i) => first + ((last - first) * i) / 11);
  const forearm = rests(shares(0.08, 0.95).map((share) => across(elbow, wrist, share)));
  const bentElbow = rests(shares(-0.15, 0.15).map((share) => across(elbow, wrist, share)));
  const bentWrist = rests(shares(0.9, 1.12).map((share) => across(elbow, wrist, share)));
  const neck = rests(
    shares(0.02, 0.05).map((above) => cut(avatar, ({ x, y }) => (Math.abs(x) < 0.1 ? y - neckJoint!.y - above : null))),
  );
  const upperArm = rests(shares(0.3, 0.9).map((share) => across(shoulder, elbow, share)));
  const deltoid = rests(shares(0.02, 0.3).map((share) => across(shoulder, elbow, share)));
  /** The thinnest cut against itself at rest, by its mean and by its least radius. */
  const thinnest = (cuts: typeof forearm) => {
    const now = cuts.map(({ crossings, rest }) => {
      const { least, mean } = radiiOf(crossings);
      return { least: least / rest.least, mean: mean / rest.mean };
    });
    return {
      least: Math.min(...now.map(({ least }) => least)),
      mean: Math.min(...now.map(({ mean }) => mean)),
    };
  };
  return { avatar, show, thinnest, forearm, upperArm, deltoid, bentElbow, bentWrist, neck };
}

const rolls = [-90, -60, -30, 0, 30, 60, 90];

describe('our mannequin’s arm', () => {
  let body: Awaited<ReturnType<typeof wearer>>;
  beforeAll(async () => {
    body = await wearer(mannequin());
  });

  test.each([
    { elbow: 0, minMean: 0.95, minAcross: 0.92 },
    { elbow: 90, minMean: 0.9, minAcross: 0.87 },
    { elbow: 140, minMean: 0.87, minAcross: 0.74 },
  ])(
    'keeps its sleeve round however the hand is rolled, the elbow bent by $elbow°',
    ({ elbow, minMean, minAcross }) => {
      const found = rolls.map((roll) => {
        body.show({ elbow, roll });
        return body.thinnest(body.forearm);
      });
      const mean = Math.min(...found.map(({ mean }) => mean));
      const least = Math.min(...found.map(({ least }) => least));
      printFigures(`sleeve at its thinnest, elbow at ${elbow}° [share of its radius]`, {
        mean: mean.toFixed(3),
        least: least.toFixed(3),
      });
      expect(mean).toBeGreaterThan(minMean);
      expect(least).toBeGreaterThan(minAcross);
    },
  );

  test('keeps its upper arm round when that is turned about itself', () => {
    for (const upperRoll of [-80, -40, 40, 80]) {
      body.show({ upperRoll });
      const [arm, shoulder] = [body.thinnest(body.upperArm), body.thinnest(body.deltoid)];
      printFigures(`upper arm turned by ${upperRoll}° [share of its radius]`, {
        mean: arm.mean.toFixed(3),
        shoulder: shoulder.least.toFixed(3),
      });
      expect(arm.mean).toBeGreaterThan(0.93);
      expect(shoulder.least).toBeGreaterThan(0.85);
    }
  });

  test.each([
    ['hanging', forward, 80],
    ['up', forward, -75],
    ['far back', down, -55],
    ['ahead', down, 95],
  ] as const)('keeps the roundness of its shoulder with the arm %s', (name, axis, angle) => {
    body.show({ swing: { axis, angle: -angle } });
    const { mean } = body.thinnest(body.deltoid);
    printFigures(`shoulder, arm ${name} [share of its radius]`, { mean: mean.toFixed(3) });
    expect(mean).toBeGreaterThan(0.95);
  });

  test('ends in a whole cuff where the hands are drawn alone', () => {
    const head = { ...makePose<'floor'>(), tracking: 'tracked' as const };
    const hand = { position: vec3(-0.3, 1.1, -0.4), orientation: quat(0, 0, 0, 1), tracking: 'tracked' as const };
    head.position.y = 1.59;
    body.avatar.setPose({ head, leftHand: hand, rightHand: null, body: null }, 10);
    body.avatar.object.updateMatrixWorld(true);
    let longest = 0;
    body.avatar.object.traverse((node) => {
      if (!(node instanceof SkinnedMesh) || !node.visible) return;
      const { index, drawRange } = node.geometry;
      for (let corner = 0; corner < Math.min(drawRange.count, index!.count); corner++) {
        const [a, b] = [index!.getX(corner), index!.getX(corner % 3 === 2 ? corner - 2 : corner + 1)];
        longest = Math.max(longest, placeOf(node, a).distanceTo(placeOf(node, b)));
      }
    });
    expect(longest, 'longest edge of a triangle [m]').toBeLessThan(0.06);
  });
});

describe.each(['woman', 'man', 'stout', 'child'])('the skin of the %s', (name) => {
  test('keeps 85 % of its girth at elbow, wrist and neck when they bend', async () => {
    const body = await wearer(builtInFile(name));
    const girth = (part: 'bentElbow' | 'bentWrist' | 'neck', turns: readonly Turn[]): number =>
      Math.min(
        ...turns.map((turn) => {
          body.show(turn);
          return body.thinnest(body[part]).mean;
        }),
      );
    const found = {
      elbow: girth('bentElbow', [{ elbow: 140 }]),
      wrist: girth('bentWrist', [{ wrist: 70 }, { wrist: -70 }]),
      neck: girth('neck', [{ headTurn: 60 }, { headTurn: -60 }, { headBend: 40 }, { headBend: -40 }]),
    };
    printFigures(`${name}, bent [share of the radius]`, {
      elbow: found.elbow.toFixed(3),
      wrist: found.wrist.toFixed(3),
      neck: found.neck.toFixed(3),
    });
    for (const [joint, share] of Object.entries(found)) expect(share, joint).toBeGreaterThan(0.85);
    body.avatar.dispose();
  });
});
