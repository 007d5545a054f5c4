import { type Calibration, skeletonFromCalibration } from 'threepoint/core';
import { distance, length, sides } from 'threepoint/math';
import { rounded } from './measures';
import type { RecordedFrame } from './recordings';

/** Simulated wrists lie up to this far beside the true ones [m]: nearer than that, no wrist counts as out of reach. */
const tolerance = 0.01;

/**
 * Wrists that a body of this calibration cannot reach with its true shoulders: where many are, calibration or recording
 * is wrong.
 */
export interface Reach {
  wrists: number;
  beyond: number;
  /** How much further than the arm is long, at most [m]. */
  furthest: number;
}

export const emptyReach = (): Reach => ({ wrists: 0, beyond: 0, furthest: 0 });

export function addReach(reach: Reach, calibration: Calibration, frames: readonly RecordedFrame[]): void {
  const { restOffsets } = skeletonFromCalibration(calibration);
  for (const side of sides) {
    const arm = length(restOffsets[`${side}LowerArm`]) + length(restOffsets[`${side}Hand`]);
    for (const { frame, truth } of frames) {
      const wrist = frame[`${side}Hand`]?.position;
      if (!wrist) continue;
      const further = distance(wrist, truth[`${side}UpperArm`]) - arm;
      reach.wrists += 1;
      if (further <= tolerance) continue;
      reach.beyond += 1;
      reach.furthest = Math.max(reach.furthest, further);
    }
  }
}

export function mergeReaches(parts: readonly Reach[]): Reach {
  const whole = emptyReach();
  for (const { wrists, beyond, furthest } of parts) {
    whole.wrists += wrists;
    whole.beyond += beyond;
    whole.furthest = Math.max(whole.furthest, furthest);
  }
  return whole;
}

export const reachReport = ({ wrists, beyond, furthest }: Reach) => ({
  beyondShare: rounded(beyond / wrists, 4),
  furthestCm: rounded(furthest * 100, 2),
});

/** Returns a sentence on all people, and on those with more than 5 % of wrists out of reach. */
export function reachText(byPerson: ReadonlyMap<string, Reach>): string {
  const textOf = (reach: Reach) => {
    const { beyondShare, furthestCm } = reachReport(reach);
    return `${(beyondShare * 100).toFixed(1)} %, up to ${furthestCm.toFixed(1)} cm`;
  };
  const often = [...byPerson].filter(([, reach]) => reach.beyond > 0.05 * reach.wrists);
  const who = often.map(([person, reach]) => `${person} ${textOf(reach)}`).join('; ');
  return `Wrists further from their true shoulder than the calibrated arm, by over ${tolerance * 100} cm: ${textOf(mergeReaches([...byPerson.values()]))}${who && ` (${who})`}`;
}
