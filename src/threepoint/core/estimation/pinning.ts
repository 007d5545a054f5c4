import type { TrackedFeet } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import { isPlausibleOffset, maxTrackerOffset, trackerNames } from '../body/tracker-offsets';
import type { Mutable } from '../records';
import { type TrackerMeasuring, trackerMeasuring } from '../tracking/measure-trackers';
import type { BodyTrackers } from '../tracking/tracking-frame';
import type { CompletedFrame } from './complete-hands';
import { makePinTrunkState, pinTrunk, resetPinTrunk } from './pin-trunk';
import { makeTrackedJointsState, placeTrackedJoints } from './tracked-joints';
import { type TrackerReport, TrackerWatch } from './tracker-watch';
import type { TorsoPose } from './trunk/fit-torso';
import type { TorsoBones } from './trunk/torso-bones';

/** The joints of one estimator that trackers pin. */
export class Pins {
  readonly #joints = makeTrackedJointsState();
  readonly #trunk = makePinTrunkState();
  readonly #feet: Mutable<TrackedFeet> = { left: null, right: null };
  readonly #watch: TrackerWatch;
  #offsets: Calibration['trackerOffsets'];

  constructor(calibration: Calibration, report?: TrackerReport) {
    this.#offsets = calibration.trackerOffsets;
    this.#watch = new TrackerWatch(calibration, report);
  }

  /** Sets how the trackers are worn from the next frame on. */
  calibrate(calibration: Calibration): void {
    this.#offsets = calibration.trackerOffsets;
    this.#watch.calibrate(calibration);
  }

  /** Resets the state: the next frame is the first. */
  reset(): void {
    resetPinTrunk(this.#trunk);
  }

  /** Moves the trunk onto its tracked joints. Returns the ankles that trackers pin; undefined: none is. */
  apply(
    torso: TorsoPose,
    trackers: BodyTrackers | undefined,
    frame: CompletedFrame,
    bones: TorsoBones,
    deltaSeconds: number,
  ): TrackedFeet | undefined {
    if (trackers) this.#watch.reportUnplaced(trackers, this.#offsets);
    const joints = placeTrackedJoints(this.#joints, trackers, this.#offsets);
    pinTrunk(this.#trunk, torso, joints, frame, bones, deltaSeconds);
    this.#watch.follow(joints, torso, deltaSeconds);
    this.#feet.left = joints.leftFoot;
    this.#feet.right = joints.rightFoot;
    return joints.leftFoot || joints.rightFoot ? this.#feet : undefined;
  }
}

/** The part of a body that draws trackers beyond head and hands. A page without such trackers does without it. */
export interface Pinning extends TrackerMeasuring {
  create(calibration: Calibration): Pins;
  /** Returns the same part, which passes `report` each tracker that the body does not reach for a second. */
  reportingTo(report: TrackerReport): Pinning;
  /** Throws a RangeError where the offset of a tracker is no pose, or longer than a tracker is from its joint. */
  assertOffsets(calibration: Calibration): void;
}

export const pinning: Pinning = {
  ...trackerMeasuring,
  create: (calibration) => new Pins(calibration),
  reportingTo: (report) => ({ ...pinning, create: (calibration) => new Pins(calibration, report) }),
  assertOffsets({ trackerOffsets }) {
    for (const name of trackerNames) {
      const offset = trackerOffsets?.[name];
      if (!offset || isPlausibleOffset(offset)) continue;
      throw new RangeError(
        `The offset of the tracker “${name}” is not a pose within ${maxTrackerOffset.toFixed(2)} m of it.`,
      );
    }
  },
};
