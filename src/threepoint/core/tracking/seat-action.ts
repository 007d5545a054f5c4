import type { Pose } from '../math/pose';
import type { Vec3 } from '../math/vec3';

/** A change of a seat, which a Room passes to the rules of any game; a player is the number of a seat. */
export type SeatAction =
  | { readonly type: 'join'; readonly player: number }
  | { readonly type: 'leave'; readonly player: number }
  /** The player was never away for the rules, but is on another connection: perhaps a page that knows nothing of what the old one did. */
  | { readonly type: 'reconnect'; readonly player: number }
  | { readonly type: 'ready'; readonly player: number; readonly ready: boolean }
  /** Nothing has been heard of this player for so long that where they were is forgotten. */
  | { readonly type: 'silent'; readonly player: number }
  /** The match's clock is about to be stopped: no hand keeps what it holds, and where the players were is forgotten. */
  | { readonly type: 'pause' }
  | {
      readonly type: 'pose';
      readonly player: number;
      /** Seconds of the match, by the player's own view of its clock. */
      readonly at: number;
      /** Arena frame. */
      readonly head: Vec3;
      /** Wrists, arena frame; null: not seen. */
      readonly left: Pose<'arena'> | null;
      readonly right: Pose<'arena'> | null;
    };
