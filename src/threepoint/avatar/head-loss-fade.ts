import { smoothstep } from '../core/math/damper';

/** A head that is lost for a moment changes nothing [s]. */
const holdSeconds = 0.2;
const fadeSeconds = 0.6;
const faded = 0.25;

/**
 * How solid a body is whose head the device may have lost: a body that stands still shall not look as if a person were
 * in it.
 */
export interface HeadLoss {
  /** Opacity in [0.25, 1] at this time [s]; 1 at once in the first frame that sees the head again. */
  follow(time: number, seen: boolean): number;
}

export function createHeadLoss(): HeadLoss {
  let lostAt: number | null = null;
  return {
    follow(time, seen) {
      if (seen) {
        lostAt = null;
        return 1;
      }
      lostAt ??= time;
      return 1 - (1 - faded) * smoothstep(holdSeconds, holdSeconds + fadeSeconds, time - lostAt);
    },
  };
}
