import type { Pose } from '../math/pose';
import type { Vec3 } from '../math/vec3';

/** A change of a seat, which a Room passes to the rules of any game; a player is the number of a seat. */
export type SeatAction =
  | { readonly type: 'join'; readonly player: number }
  | { readonly type: 'leave'; readonly player: number }
  /**
   * The player was never away for the rules, but is on another connection, perhaps a page without the state of the old
   * one.
   */
  | { readonly type: 'reconnect'; readonly player: number }
  | { readonly type: 'ready'; readonly player: number; readonly ready: boolean }
  /** The player has sent nothing for so long that their position is discarded. */
  | { readonly type: 'silent'; readonly player: number }
  /** The match's clock is about to stop: hands release what they hold, and the players' positions are discarded. */
  | { readonly type: 'pause' }
  | {
      readonly type: 'pose';
      readonly player: number;
      /** The time of the match [s], by the player's own view of its clock. */
      readonly at: number;
      /** Arena frame. */
      readonly head: Vec3;
      /** Wrists, arena frame; null: not seen. */
      readonly left: Pose<'arena'> | null;
      readonly right: Pose<'arena'> | null;
    };
