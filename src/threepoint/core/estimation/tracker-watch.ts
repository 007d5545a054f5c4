import type { Calibration } from '../body/calibration';
import { legProportions } from '../body/leg-proportions';
import { type TrackerName, trackerNames } from '../body/tracker-offsets';
import { distance } from '../math/vec3';
import { recordOf } from '../records';
import type { BodyTrackers } from '../tracking/tracking-frame';
import type { TrackedJoints } from './tracked-joints';
import type { TorsoPose } from './trunk/fit-torso';

/** A tracked joint that stays this far [m] from the drawn one for so long [s] is out of reach. */
const farApart = 0.05;
const patience = 1;

/** A tracker whose joint the body has not reached for a second, or that has no offset. */
export interface TrackerMismatch {
  readonly tracker: TrackerName;
  /** The distance [m] out of reach; 0: the calibration has no offset of this tracker, which is not used. */
  readonly far: number;
  /** A sentence for people that names the tracker, the distance, and what to do. */
  readonly message: string;
}

export type TrackerReport = (mismatch: TrackerMismatch) => void;

const furtherThanLeg = 'further from the hips than this body’s leg reaches';
/** The tracker in a message, and where its joint is out of reach. */
const words: Readonly<Record<TrackerName, readonly [string, string]>> = {
  hips: ['hips', 'further from the head than this body’s trunk reaches'],
  chest: ['chest', 'from where head and hips leave this body’s chest'],
  leftFoot: ['left foot', furtherThanLeg],
  rightFoot: ['right foot', furtherThanLeg],
};

/** Reports tracked joints that the body does not reach, each once until it has been reached. */
export class TrackerWatch {
  readonly #report: TrackerReport | undefined;
  /** The time [s] for which each joint has been out of reach. */
  readonly #seconds = recordOf(trackerNames, () => 0);
  /** Whether each tracker was reported to have no offset. */
  readonly #unplaced = recordOf(trackerNames, () => false);
  #legReach = 0;

  constructor(calibration: Calibration, report?: TrackerReport) {
    this.#report = report;
    this.calibrate(calibration);
  }

  /** Sets the measures; what is still out of reach is reported once more. */
  calibrate({ eyeHeight }: Calibration): void {
    // From the hips to the ankle of a straight leg that is held out to its side.
    this.#legReach = (legProportions.hip - legProportions.ankle + legProportions.aside) * eyeHeight;
    for (const name of trackerNames) {
      this.#seconds[name] = 0;
      this.#unplaced[name] = false;
    }
  }

  /** Reports trackers without an offset, each once for each calibration. */
  reportUnplaced(trackers: BodyTrackers, offsets: Calibration['trackerOffsets']): void {
    for (let i = 0; i < trackerNames.length; i++) {
      const name = trackerNames[i]!;
      if (!trackers[name] || offsets?.[name] || this.#unplaced[name]) continue;
      this.#unplaced[name] = true;
      const message = `The ${words[name][0]} tracker is not used: the calibration has no trackerOffsets.${name}.`;
      this.#report?.({ tracker: name, far: 0, message });
    }
  }

  /** Compares the joints by their trackers with the trunk that was drawn, floor frame. */
  follow(joints: TrackedJoints, { hips, chest }: TorsoPose, deltaSeconds: number): void {
    for (let i = 0; i < trackerNames.length; i++) {
      const name = trackerNames[i]!;
      const joint = joints[name]?.position;
      const limb = name.endsWith('Foot') ? this.#legReach : 0;
      const far = joint ? distance(joint, name === 'chest' ? chest : hips) - limb : 0;
      const before = this.#seconds[name];
      const seconds = far > farApart ? before + Math.max(deltaSeconds, 0) : 0;
      this.#seconds[name] = seconds;
      if (before > patience || seconds <= patience) continue;
      const [named, where] = words[name];
      const centimetres = Math.round(100 * far);
      const message = `The ${named} tracker is ${centimetres} cm ${where}. Calibrate, or check where it is worn.`;
      this.#report?.({ tracker: name, far, message });
    }
  }
}
