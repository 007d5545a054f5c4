import { type MutableUpperBodyPose, makeUpperBodyPose, type TrackedFeet } from '../body/avatar-pose';
import { type Calibration, isSpanMeasured } from '../body/calibration';
import { type Fingers, unknownFingers } from '../body/hand-shape';
import { writeLocalRotations } from '../body/local-rotations';
import { averageSkeleton, chestSpaceBody } from '../body/skeleton';
import { invertTransform, makePose, makeTransform, type TrackedPose, transformPose } from '../math/pose';
import { rotate } from '../math/quat';
import { copyVec3, vec3 } from '../math/vec3';
import type { DeviceBody } from '../tracking/device-body';
import { floorFromHeading } from '../tracking/heading';
import { assertPinning, type TrackingFrame } from '../tracking/tracking-frame';
import { armBones, fitArms, makeFitArmsState, resetFitArms } from './arms/fit-arms';
import { type CompletedFrame, completeHands, makeCompleteHandsState, resetCompleteHands } from './complete-hands';
import { type HandTurn, makeIkSolution, makeThreePoints, solveIk } from './ik/solve-ik';
import { makeJoints } from './joint-positions';
import type { JointSource, SolvedFrame } from './joint-source';
import { limitJoints, makeLimitJointsState, resetLimitJoints } from './limit-joints';
import type { OrientationRule } from './methods/paper-orientations';
import {
  calibrateHandTilts,
  estimateHandTilt,
  makeHandTiltsState,
  resetHandTilts,
} from './online-calibration/estimate-hand-tilts';
import {
  estimateHeadsetRise,
  makeHeadsetRiseState,
  resetHeadsetRise,
} from './online-calibration/estimate-headset-rise';
import { HeadsetMountCorrection } from './online-calibration/headset-mount-correction';
import type { Pinning, Pins } from './pinning';
import type { Estimate, EstimatorName, InferenceRequest, PoseEstimator } from './pose-estimator';
import { makeSteadyTrackersState, resetSteadyTrackers, steadyTrackers } from './steady-trackers';
import { fitTorso, makeFitTorsoState, resetFitTorso } from './trunk/fit-torso';
import { torsoBones } from './trunk/torso-bones';

/** The longest gap between frames [s] that counts as motion; after a longer one filters and memories are reset. */
const longestGapSeconds = 0.5;

/** Returns the measures of the user's body that the stages need. */
function measure(calibration: Calibration) {
  const skeleton = averageSkeleton(calibration);
  return {
    chestSpace: chestSpaceBody(calibration),
    torso: torsoBones(skeleton),
    arm: armBones(skeleton),
    spanMeasured: isSpanMeasured(calibration),
  };
}

/** Creates the state of all stages for one user; each stage writes its own part only. */
function makeEstimatorState({ handTilts }: Calibration) {
  const hands = makeCompleteHandsState();
  const trackers = makeSteadyTrackersState();
  return {
    hands,
    trackers,
    tilts: makeHandTiltsState(handTilts),
    headset: makeHeadsetRiseState(),
    solved: {
      time: Number.NaN,
      completed: hands.frame,
      trackers,
      floorFromHeading: makeTransform<'floor', 'heading'>(),
      points: makeThreePoints(),
      ik: makeIkSolution(),
      deviceBody: null as DeviceBody | null,
    } satisfies SolvedFrame,
    /** The six joints of stage 3, floor frame. */
    joints: makeJoints(),
    limited: makeLimitJointsState(),
    torso: makeFitTorsoState(),
    arms: makeFitArmsState(),
  };
}

type EstimatorState = ReturnType<typeof makeEstimatorState>;

/** The head before the first frame. */
const noHead: TrackedPose = { ...makePose<'floor'>(), tracking: 'emulated' };

/** The result of `update`, overwritten by the next. */
interface OwnedPose {
  head: TrackedPose;
  leftHand: TrackedPose | null;
  rightHand: TrackedPose | null;
  readonly body: MutableUpperBodyPose;
  fingers: Fingers;
  feet: TrackedFeet | undefined;
}

export interface PipelineOptions {
  /** Whether filters and speed limits are left out, for benches that measure their cost. */
  readonly frameByFrame?: boolean;
  /** Draws the trackers of frames; absent: frames must have none. */
  readonly pinning?: Pinning | undefined;
  /** Replaces torso and arm fitting, frame by frame; absent: these draw the body. */
  readonly orientations?: OrientationRule | undefined;
}

/**
 * An estimator with a body: complete hands → steady trackers → solve IK → correct (the source) → limit joints → fit
 * torso, pin trunk, fit arms. A method is its source; every other stage is the same for all.
 */
export class Pipeline implements PoseEstimator {
  readonly name: EstimatorName;
  readonly source: JointSource;
  /** The state of the newest frame; for benches that measure single stages. */
  readonly state: EstimatorState;
  readonly #headingFromFloor = makeTransform<'heading', 'floor'>();
  /** IK's poles, floor frame. */
  readonly #poles = { left: vec3(0, 0, 0), right: vec3(0, 0, 0) };
  readonly #estimate: { readonly pose: OwnedPose; request: InferenceRequest | null };
  readonly #request: InferenceRequest;
  readonly #headset: HeadsetMountCorrection;
  #body: ReturnType<typeof measure>;
  #lastTime = Number.NaN;
  /** The time since the previous frame [s]. */
  #deltaSeconds = 0;
  /** The turn of a hand by its tilt; a hand that is not seen keeps the last one. */
  readonly #turnHand: HandTurn = (side, untiltedForearm) => {
    const { hands, tilts } = this.state;
    const { source } = side === 'left' ? hands.frame.leftHand : hands.frame.rightHand;
    return source === 'tracked'
      ? estimateHandTilt(tilts, side, untiltedForearm, this.#deltaSeconds)
      : tilts.turns[side];
  };
  readonly #frameByFrame: boolean;
  readonly #orientations: OrientationRule | undefined;
  readonly #pins: Pins | undefined;

  constructor(name: EstimatorName, calibration: Calibration, source: JointSource, options: PipelineOptions = {}) {
    this.name = name;
    this.#orientations = options.orientations;
    this.#frameByFrame = options.frameByFrame ?? options.orientations !== undefined;
    this.#pins = options.pinning?.create(calibration);
    this.source = source;
    this.state = makeEstimatorState(calibration);
    this.#headset = new HeadsetMountCorrection(calibration);
    this.#body = measure(calibration);
    this.#request = { ask: () => source.network?.ask(this.state.solved) ?? Promise.resolve() };
    this.#estimate = {
      pose: {
        head: noHead,
        leftHand: null,
        rightHand: null,
        body: makeUpperBodyPose(),
        fingers: unknownFingers,
        feet: undefined,
      },
      request: null,
    };
  }

  calibrate(calibration: Calibration): void {
    this.#headset.calibrate(calibration);
    this.#pins?.calibrate(calibration);
    this.#body = measure(calibration);
    calibrateHandTilts(this.state.tilts, calibration.handTilts);
    resetHeadsetRise(this.state.headset);
    this.source.calibrate(this.#body.chestSpace);
  }

  reset(): void {
    const { hands, trackers, tilts, limited, torso, arms } = this.state;
    resetCompleteHands(hands);
    resetSteadyTrackers(trackers);
    resetHandTilts(tilts);
    this.source.reset();
    resetLimitJoints(limited);
    resetFitTorso(torso);
    this.#pins?.reset();
    resetFitArms(arms);
    this.#lastTime = Number.NaN;
  }

  fault(): string | null {
    return this.source.network?.fault ?? null;
  }

  update(frame: TrackingFrame): Estimate {
    assertPinning(frame.trackers, this.#pins);
    const { state } = this;
    const body = this.#body;
    const deltaSeconds = this.#elapsed(frame.time);
    const { rise } = state.headset;
    const head = this.#headset.apply(frame.head, rise);

    const completed = completeHands(state.hands, head, frame, body.chestSpace, deltaSeconds);
    const step = this.#frameByFrame ? Number.POSITIVE_INFINITY : deltaSeconds;
    steadyTrackers(state.trackers, completed, step);
    this.#deltaSeconds = deltaSeconds;
    const solved = this.#solve(frame);
    // An underestimated arm length is indistinguishable from a raised headset.
    if (body.spanMeasured) estimateHeadsetRise(state.headset, solved, body.chestSpace.arm, rise, deltaSeconds);
    this.source.joints(solved, step, state.joints);
    this.#estimate.request = this.source.network?.wantsFrames ? this.#request : null;
    const { pose } = this.#estimate;
    pose.head = head;
    pose.leftHand = frame.leftHand;
    pose.rightHand = frame.rightHand;
    pose.fingers = frame.fingers ?? unknownFingers;
    if (this.#orientations) {
      const { hips, trunk, clavicles, arms } = this.#orientations(state.joints, completed, body.torso, body.arm);
      copyVec3(hips, pose.body.hipsPosition);
      writeLocalRotations(trunk, head.orientation, clavicles, arms, pose.body.localRotations);
    } else this.#fit(frame, head, completed, step);
    return this.#estimate;
  }

  /** Writes the body by limits of speed, torso and arm fitting (stages 4 and 5). */
  #fit(frame: TrackingFrame, head: TrackedPose, completed: CompletedFrame, step: number): void {
    const { state } = this;
    const body = this.#body;
    const { pose } = this.#estimate;
    const joints = limitJoints(state.limited, state.joints, completed, step);
    const torso = fitTorso(state.torso, joints, completed, body.torso, step);
    pose.feet = this.#pins?.apply(torso, frame.trackers, completed, body.torso, step);
    const armsInput = { frame: completed, joints, torso, bones: body.arm, poles: this.#poles };
    const arms = fitArms(state.arms, armsInput, step);
    copyVec3(torso.hips, pose.body.hipsPosition);
    writeLocalRotations(torso.rotations, head.orientation, torso.clavicles, arms, pose.body.localRotations);
  }

  /**
   * Returns the time [s] since the last frame; 0 for the first frame and after a reset by a pause, a time that runs
   * backwards or an invalid time.
   */
  #elapsed(time: number): number {
    const elapsed = time - this.#lastTime;
    const continues = elapsed >= 0 && elapsed <= longestGapSeconds;
    if (!continues) this.reset();
    this.#lastTime = time;
    return continues ? elapsed : 0;
  }

  /** Stage 2 in the heading frame. */
  #solve({ time, deviceBody }: TrackingFrame): SolvedFrame {
    const { solved, trackers } = this.state;
    const { head, leftHand, rightHand } = trackers;
    solved.time = time;
    solved.deviceBody = deviceBody ?? null;
    floorFromHeading(head.value, solved.floorFromHeading);
    invertTransform(solved.floorFromHeading, this.#headingFromFloor);
    transformPose(this.#headingFromFloor, head.value, solved.points.head);
    transformPose(this.#headingFromFloor, leftHand.value, solved.points.leftHand);
    transformPose(this.#headingFromFloor, rightHand.value, solved.points.rightHand);
    solveIk(solved.points, this.#turnHand, this.#body.chestSpace, solved.ik);
    rotate(solved.floorFromHeading.orientation, solved.ik.poles.left, this.#poles.left);
    rotate(solved.floorFromHeading.orientation, solved.ik.poles.right, this.#poles.right);
    return solved;
  }
}
