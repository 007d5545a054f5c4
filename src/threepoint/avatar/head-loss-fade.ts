import { smoothstep } from '../core/math/damper';

/** The time for which a lost head changes nothing [s]. */
const holdSeconds = 0.2;
const fadeSeconds = 0.6;
const faded = 0.25;

/** Fades a body whose head is lost, so that a body that stands still does not look as if a person moved it. */
interface HeadLossFade {
  /** Returns the opacity in [0.25, 1] at this time [s]; 1 in the first frame with a tracked head. */
  opacityAt(time: number, seen: boolean): number;
}

export function createHeadLossFade(): HeadLossFade {
  let lostAt: number | null = null;
  return {
    opacityAt(time, seen) {
      if (seen) {
        lostAt = null;
        return 1;
      }
      lostAt ??= time;
      return 1 - (1 - faded) * smoothstep(holdSeconds, holdSeconds + fadeSeconds, time - lostAt);
    },
  };
}
