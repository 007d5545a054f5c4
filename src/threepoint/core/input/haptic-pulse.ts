import type { Side } from '../math/side';

/** A haptic pulse for one hand. */
export interface HapticPulse {
  readonly side: Side;
  /** 0 to 1. */
  readonly strength: number;
  readonly seconds: number;
}
