import { readFileSync } from 'node:fs';
import { type Calibration, forwardKinematics, jointNames, recordOf, skeletonFromCalibration } from 'threepoint/core';
import { parseAvatar } from 'threepoint/files';
import { identity, type Pose } from 'threepoint/math';
import type { LegProportions } from '../../../src/threepoint/avatar/legs/leg-posture';
import { legProportionsOf } from '../../../src/threepoint/avatar/legs/legs';
import { Rig } from '../../../src/threepoint/avatar/rig/rig';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import type { GaitPoints } from '../../../src/threepoint/core/estimation/gait/gait-features';
import type { PoseRegressor } from '../../../src/threepoint/core/estimation/networks/pose-regressor';
import { createWithNetwork } from '../../../src/threepoint/core/estimation/with-network';
import { calibrationOf, type RecordedFrame, type RecordingIndex, readClip } from '../recordings';
import type { LegClip } from './leg-measures';
import { type Contact, contactsOf, footHeights, readLegs, type TrueLegs } from './leg-truth';

/** The source of the hips that the legs follow: the recording, or a body that the page draws. */
export const legDrivers = ['truth', 'ik', 'learned'] as const;
export type LegDriver = (typeof legDrivers)[number];

/** One clip with legs: where they truly are, which feet stand, and every driver's hips. */
export interface DrivenLegs {
  readonly person: string;
  readonly calibration: Calibration;
  readonly truth: readonly TrueLegs[];
  readonly contacts: readonly Contact[];
  /** The height of the person's ankle while the foot stands [m]. */
  readonly standingAnkle: number;
  readonly hips: Readonly<Record<LegDriver, readonly Pose<'floor'>[]>>;
  /** Head and hands as tracked. */
  readonly points: readonly Omit<GaitPoints, 'hips'>[];
}

/** The hips that the page's estimator draws, frame by frame. */
async function drawnHips(
  name: 'ik' | 'learned',
  calibration: Calibration,
  regressor: PoseRegressor | null,
  frames: readonly RecordedFrame[],
): Promise<Pose<'floor'>[]> {
  const estimator = name === 'ik' ? createIk(calibration) : createWithNetwork(name, calibration, regressor);
  const skeleton = skeletonFromCalibration(calibration);
  const drawn: Pose<'floor'>[] = [];
  for (const { frame } of frames) {
    const { pose, request } = estimator.update(frame);
    await request?.ask();
    if (!pose.body) throw new Error(`${name} drew no body`);
    const { position, orientation } = forwardKinematics(skeleton, pose.body).hips;
    drawn.push({ position: { ...position }, orientation: { ...orientation } });
  }
  return drawn;
}

/** Every clip of a person that has legs, driven. */
export async function driveLegs(
  recordings: string,
  index: RecordingIndex,
  person: string,
  learned: PoseRegressor | null,
): Promise<DrivenLegs[]> {
  const clips = index.clips.filter((clip) => clip.person === person);
  const truths = clips.map((clip) => ({ clip, truth: readLegs(recordings, index, clip) }));
  const whole = truths.flatMap(({ clip, truth }) => (truth ? [{ clip, truth }] : []));
  const heights = footHeights(whole.map(({ truth }) => truth));
  const driven: DrivenLegs[] = [];
  for (const { clip, truth } of whole) {
    const frames = readClip(recordings, index, clip);
    const calibration = calibrationOf(index, clip, { hands: true });
    driven.push({
      person,
      calibration,
      truth,
      contacts: contactsOf(truth, heights, index.rateHz),
      standingAnkle: heights.ankle,
      hips: {
        truth: truth.map(({ hips }) => hips),
        ik: await drawnHips('ik', calibration, null, frames),
        learned: await drawnHips('learned', calibration, learned, frames),
      },
      points: frames.map(({ frame, truth }) => ({
        head: frame.head,
        leftHand: frame.leftHand?.position ?? truth.leftHand,
        rightHand: frame.rightHand?.position ?? truth.rightHand,
      })),
    });
  }
  return driven;
}

/** The clip as it is measured under one driver's hips. */
export const bodyOf = ({ truth, contacts, points, hips }: DrivenLegs, driver: LegDriver, rateHz: number): LegClip => ({
  truth,
  contacts,
  rateHz,
  body: points.map((point, row) => ({ ...point, hips: hips[driver][row]! })),
});

const mannequin = new URL('../../../public/avatars/mannequin.vrm', import.meta.url);

/** The legs that the page's mannequin has on a calibrated body. */
export async function mannequinLegs(): Promise<(calibration: Calibration) => LegProportions> {
  const { buffer, byteOffset, byteLength } = readFileSync(mannequin);
  const bytes = buffer.slice(byteOffset, byteOffset + byteLength) as ArrayBuffer;
  const { vrm } = await parseAvatar(bytes, 'mannequin.vrm');
  vrm.scene.updateMatrixWorld(true);
  const rig = new Rig(vrm);
  const upright = recordOf(jointNames, () => identity);
  return (calibration) => {
    const skeleton = skeletonFromCalibration(calibration);
    const { hips, head } = forwardKinematics(skeleton, {
      hipsPosition: skeleton.restOffsets.hips,
      localRotations: upright,
    });
    return legProportionsOf(rig, hips.position.y, head.position.y / (rig.rest('head')?.y ?? 1));
  };
}
