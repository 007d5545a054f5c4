import {
  type Calibration,
  calibrationProblem,
  defaultCalibration,
  eyeHeightRange,
  withEyeHeight,
} from '../body/calibration';
import { averageSkeleton } from '../body/skeleton';
import { isTracked } from '../math/pose';
import { fromAxisAngle, rotate } from '../math/quat';
import { right, zero } from '../math/vec3';
import type { TrackingFrame } from './tracking-frame';

/** The time [s] at a height that proves it, longer than a jump. */
const provingSeconds = 1.25;
/** The range [m] within which eyes rise and sink in that time while a person stands or walks. */
const calmRange = 0.04;
/** The ignored excess as a fraction of the eye height: shoes, and a headset that sits differently. */
const deadZone = 0.02;
/**
 * The ignored excess once the calibration has grown: the measured one was wrong, and a user who straightens up is
 * followed.
 */
const grownDeadZone = 0.005;
/** The largest growth as a fraction of the measured eye height: a user who rises further stands on something. */
const maxGrowth = 0.08;
/** The longest gap between two frames [s] without an unobserved motion. */
const longestGap = 0.5;

/** A period in which the eyes stayed within `calmRange`: start and end [s], lowest and highest [m]. */
interface CalmStand {
  readonly since: number;
  readonly until: number;
  readonly lowest: number;
  readonly highest: number;
}

/**
 * Detects a user who stands taller than the calibration. A lower headset proves nothing: people crouch, slouch and sit.
 */
export function createGrowthDetector() {
  let current: Calibration | null = null;
  /** The eye height [m] before any growth, and the highest plausible one: above it a user stands on something. */
  let measured = 0;
  let highest = 0;
  /** From the skull's pivot to the eyes, in the frame of a headset whose user looks straight ahead. */
  let eyesInHeadset = zero;
  /** The height [m] of the eyes above that pivot then. */
  let levelRise = 0;
  let stand: CalmStand | null = null;

  function take(calibration: Calibration): void {
    current = calibration;
    measured = calibration.eyeHeight;
    // The height of a user with the default body is unknown if they have been sitting: any height is possible.
    highest = calibration === defaultCalibration ? eyeHeightRange.max : measured * (1 + maxGrowth);
    const { eyesInHead } = averageSkeleton(calibration);
    eyesInHeadset = rotate(fromAxisAngle(right, -(calibration.gazePitch ?? 0)), eyesInHead);
    levelRise = eyesInHead.y;
    stand = null;
  }

  /** Returns the height [m] of the eyes with a level head, because looking up lifts the headset. */
  function levelHeight({ position, orientation }: TrackingFrame['head']): number {
    return position.y - rotate(orientation, eyesInHeadset).y + levelRise;
  }

  return {
    /**
     * Observes a frame with the calibration in use. Returns a larger calibration in the frame that proves it too small,
     * else null. Another object is another calibration, unless it is the returned one.
     */
    observe({ time, head }: TrackingFrame, calibration: Calibration): Calibration | null {
      if (calibration !== current) take(calibration);
      const height = levelHeight(head);
      const zone = calibration.eyeHeight > measured ? grownDeadZone : deadZone;
      const proves = isTracked(head) && height > calibration.eyeHeight * (1 + zone) && height <= highest;
      stand = proves ? prolonged(stand, time, height) : null;
      if (!stand || time - stand.since < provingSeconds) return null;
      const grown = withEyeHeight(calibration, (stand.lowest + stand.highest) / 2);
      stand = null;
      if (calibrationProblem(grown) !== null) return null;
      if (calibration === defaultCalibration) take(grown);
      else current = grown;
      return grown;
    },
    /** Discards the observed height: the floor lies elsewhere, or another person wears the headset. */
    reset(): void {
      stand = null;
    },
  };
}

/** Returns the period with one more frame, or a new one where the head moved or was not seen. */
function prolonged(stand: CalmStand | null, time: number, height: number): CalmStand {
  const begun: CalmStand = { since: time, until: time, lowest: height, highest: height };
  if (!stand || time < stand.until || time - stand.until > longestGap) return begun;
  const lowest = Math.min(stand.lowest, height);
  const highest = Math.max(stand.highest, height);
  return highest - lowest > calmRange ? begun : { since: stand.since, until: time, lowest, highest };
}
