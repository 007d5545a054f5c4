import { recordOf } from 'threepoint/core';
import { add, copyVec3, distance, type MutableVec3, rotate, type Side, sides, type Vec3, vec3 } from 'threepoint/math';
import type { LegPose, LegPosture, LegProportions } from '../../../src/threepoint/avatar/legs/leg-posture';
import type { GaitPoints } from '../../../src/threepoint/core/estimation/gait/gait-features';
import { mean } from '../../../src/threepoint/core/math/statistics';
import { rounded } from '../measures';
import type { Contact, TrueLeg, TrueLegs } from './leg-truth';

/** The ball of the mannequin's foot: ahead of the ankle and over the floor, in heights of its ankle. */
const ballAhead = 1.58;
const ballHeight = 0.32;
/** A drawn foot stands where its sole is no higher than this [m]. */
const onFloor = 0.01;

/**
 * Sums over feet and frames of some clips. standing: frames of feet that truly stand; skate, trueSkate, float: the
 * drawn and the true foot's speed [m/s] and the height of the drawn sole [m] in them; drawnStanding, slide: frames of
 * drawn feet that stand, and their speed [m/s]; agreed: frames in which drawn and true foot agree on whether they
 * stand.
 */
const sums = [
  'feet',
  'pelvis',
  'knee',
  'ankle',
  'standing',
  'skate',
  'trueSkate',
  'float',
  'drawnStanding',
  'slide',
  'sink',
  'agreed',
] as const;
export type LegMeasures = Record<(typeof sums)[number], number>;
export const emptyLegMeasures = (): LegMeasures => recordOf(sums, () => 0);

/** What is drawn of one leg, floor frame [m]. */
interface Drawn {
  readonly knee: MutableVec3;
  readonly ankle: MutableVec3;
  readonly ball: MutableVec3;
}

const makeDrawn = (): Drawn => ({ knee: vec3(0, 0, 0), ankle: vec3(0, 0, 0), ball: vec3(0, 0, 0) });

function drawnOf({ knee, ankle, foot }: LegPose, { ankleHeight }: LegProportions, target: Drawn): void {
  copyVec3(knee, target.knee);
  copyVec3(ankle, target.ankle);
  rotate(foot, vec3(0, (ballHeight - 1) * ankleHeight, -ballAhead * ankleHeight), target.ball);
  add(ankle, target.ball, target.ball);
}

const across = (a: Vec3, b: Vec3): number => Math.hypot(a.x - b.x, a.z - b.z);

/** A foot that rolls over heel or toes does not skate: the slower of ankle and ball, along the floor. */
const skateOf = (now: { ankle: Vec3; ball: Vec3 }, before: { ankle: Vec3; ball: Vec3 }, rateHz: number): number =>
  Math.min(across(now.ankle, before.ankle), across(now.ball, before.ball)) * rateHz;

export interface LegClip {
  readonly truth: readonly TrueLegs[];
  readonly contacts: readonly Contact[];
  /** The drawn body above the legs, in order at `rateHz`. */
  readonly body: readonly GaitPoints[];
  readonly rateHz: number;
}

/** Lets legs stand and step under the hips of one clip and adds how they fit the truth. */
export function addLegs(
  measures: LegMeasures,
  { truth, contacts, body, rateHz }: LegClip,
  posture: LegPosture,
  proportions: LegProportions,
): void {
  const now: Record<Side, Drawn> = { left: makeDrawn(), right: makeDrawn() };
  const before: Record<Side, Drawn> = { left: makeDrawn(), right: makeDrawn() };
  truth.forEach((frame, row) => {
    const points = body[row]!;
    posture.update(points, row === 0 ? 0 : 1 / rateHz);
    const last = truth[row - 1];
    for (const side of sides) {
      copyVec3(now[side].ankle, before[side].ankle);
      copyVec3(now[side].ball, before[side].ball);
      drawnOf(posture.legs[side], proportions, now[side]);
      if (!last) continue;
      measures.pelvis += distance(points.hips.position, frame.hips.position);
      addFoot(measures, {
        drawn: now[side],
        drawnBefore: before[side],
        truth: frame[side],
        truthBefore: last[side],
        stands: contacts[row]![side],
        ankleHeight: proportions.ankleHeight,
        rateHz,
      });
    }
  });
}

/** A leg in one frame as drawn and as it was, each with the frame before. */
interface FootFrame {
  readonly drawn: Drawn;
  readonly drawnBefore: Drawn;
  readonly truth: TrueLeg;
  readonly truthBefore: TrueLeg;
  readonly stands: boolean;
  readonly ankleHeight: number;
  readonly rateHz: number;
}

function addFoot(measures: LegMeasures, foot: FootFrame): void {
  const { drawn, truth, stands, ankleHeight, rateHz } = foot;
  measures.feet += 1;
  measures.knee += distance(drawn.knee, truth.knee);
  measures.ankle += distance(drawn.ankle, truth.ankle);
  const sole = Math.min(drawn.ankle.y - ankleHeight, drawn.ball.y - ballHeight * ankleHeight);
  const skate = skateOf(drawn, foot.drawnBefore, rateHz);
  measures.sink += Math.max(0, -sole);
  if (stands) {
    measures.standing += 1;
    measures.skate += skate;
    measures.trueSkate += skateOf(truth, foot.truthBefore, rateHz);
    measures.float += Math.max(0, sole);
  }
  const drawnStands = sole < onFloor;
  if (drawnStands) {
    measures.drawnStanding += 1;
    measures.slide += skate;
  }
  if (drawnStands === stands) measures.agreed += 1;
}

export function legReport(m: LegMeasures) {
  const cm = (sum: number, count: number): number => rounded((sum / Math.max(1, count)) * 100, 2);
  return {
    pelvisCm: cm(m.pelvis, m.feet),
    kneeCm: cm(m.knee, m.feet),
    footCm: cm(m.ankle, m.feet),
    /** The speed of drawn and true feet while the true foot stands, and of drawn feet while they stand [cm/s]. */
    skateCmS: cm(m.skate, m.standing),
    trueSkateCmS: cm(m.trueSkate, m.standing),
    slideCmS: cm(m.slide, m.drawnStanding),
    /** The height of the drawn sole while the true foot stands, and its depth below the floor at any time [cm]. */
    floatCm: cm(m.float, m.standing),
    sinkCm: cm(m.sink, m.feet),
    /** Feet that truly stand, and feet of which drawn and truth agree on that [share]. */
    standing: rounded(m.standing / Math.max(1, m.feet), 3),
    agreed: rounded(m.agreed / Math.max(1, m.feet), 3),
  };
}

export type LegReport = Readonly<ReturnType<typeof legReport>>;

/** All people alike: the mean over people of each figure. */
export function meanReport(reports: readonly LegReport[]): LegReport {
  const meanOf = (key: keyof LegReport) => rounded(mean(reports.map((report) => report[key])), 3);
  const keys = Object.keys(reports[0]!) as (keyof LegReport)[];
  return recordOf(keys, meanOf);
}
