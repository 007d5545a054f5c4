import { type FingerName, lerpHandShape, makeHandShape, type TrackingFrame } from 'threepoint/core';
import {
  backward,
  type Pose,
  type Quat,
  right,
  rotate,
  type Side,
  transformPoint,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { averageHand, fingerPoints, makeFingerPoints, mirrorPoint } from '../../src/threepoint/core/body/hand-geometry';
import { closedHand, fingerNames, relaxedHand } from '../../src/threepoint/core/body/hand-shape';

const ends = ['proximal', 'intermediate', 'distal'];
const joints: readonly { readonly name: string; readonly finger: FingerName; readonly joint: number }[] =
  fingerNames.flatMap((finger) => {
    const long = finger === 'little' ? 'pinky-finger' : `${finger}-finger`;
    const names =
      finger === 'thumb'
        ? ['thumb-metacarpal', 'thumb-phalanx-proximal', 'thumb-phalanx-distal', 'thumb-tip']
        : [...ends.map((end) => `${long}-phalanx-${end}`), `${long}-tip`];
    return names.map((name, joint) => ({ name, finger, joint }));
  });

/** Column by column, as WebXR writes it. */
function writeMatrix({ x, y, z }: Vec3, turned: Quat, target: Float32Array, at: number): void {
  for (const [column, axis] of [right, up, backward].entries()) {
    const to = rotate(turned, axis);
    target.set([to.x, to.y, to.z, 0], at + 4 * column);
  }
  target.set([x, y, z, 1], at + 12);
}

/** A hand's joints in the order of its map, the wrist first. */
function matricesOf(side: Side, wrist: Pose<'floor'>, closed: number): Float32Array {
  const shape = lerpHandShape(relaxedHand, closedHand, closed, makeHandShape());
  const hand = averageHand(1.59);
  const matrices = new Float32Array(16 * (1 + joints.length));
  writeMatrix(wrist.position, wrist.orientation, matrices, 0);
  for (const [index, { finger, joint }] of joints.entries()) {
    const point = fingerPoints(finger, hand[finger], shape[finger], makeFingerPoints())[joint as 0];
    const own = side === 'left' ? point : mirrorPoint(point, vec3(0, 0, 0));
    writeMatrix(transformPoint(wrist, own), wrist.orientation, matrices, 16 * (index + 1));
  }
  return matrices;
}

/** A device that sees both hands: its frames were there before, so that it leaves nothing to the collector itself. */
export function trackedHandsDevice(frames: readonly TrackingFrame[]) {
  const seen = frames.map(({ head, leftHand, rightHand, time }) => {
    const closed = 0.5 + 0.5 * Math.sin(3 * time);
    return {
      viewer: { transform: { position: head.position, orientation: head.orientation }, emulatedPosition: false },
      left: leftHand && matricesOf('left', leftHand, closed),
      right: rightHand && matricesOf('right', rightHand, 1 - closed),
    };
  });
  let now = seen[0];
  const sourceOf = (side: Side) => {
    const names = ['wrist', ...joints.map(({ name }) => name)];
    return { handedness: side, profiles: [], hand: new Map(names.map((name) => [name, { side }])) };
  };
  const frame = {
    getViewerPose: () => now?.viewer,
    getJointPose: () => null,
    fillPoses(spaces: readonly { readonly side: Side }[], _: unknown, target: Float32Array): boolean {
      const matrices = now?.[spaces[0]?.side ?? 'left'];
      if (matrices) target.set(matrices);
      return matrices !== null;
    },
  };
  const floor = new EventTarget() as unknown as XRReferenceSpace;
  const session = new EventTarget() as unknown as XRSession;
  const inputSources = [sourceOf('left'), sourceOf('right')];
  return {
    session: Object.assign(session, { visibilityState: 'visible', inputSources }),
    drawing: { getReferenceSpace: () => floor, setReferenceSpace: () => undefined },
    /** The next frame of the device; the same object every time. */
    at(index: number): XRFrame {
      now = seen[index % seen.length];
      return frame as unknown as XRFrame;
    },
  };
}
