import type { HapticPulse, RemotePerson } from 'threepoint/core';
import type { Side, Vec3 } from 'threepoint/math';
import type { Launch } from 'threepoint-games';
import type { BallCue, BallEvent, BallRole, BallState, Opening } from 'threepoint-games/ball';
import type { ConnectionStatus } from 'threepoint-rooms/room';

/**
 * A person or bot at the court in one frame. Heads and palms are the same objects in every frame: copy what must stay.
 */
export interface PlayerFrame {
  readonly name: string;
  readonly bot: boolean;
  readonly presence: 'here' | 'away' | 'gone';
  readonly me: boolean;
  readonly role: BallRole;
  readonly station: number;
  readonly ready: boolean;
  /** The position of the head, arena frame; null: it is not visible now. */
  readonly head: Vec3 | null;
  /** The position of a ball in each hand, arena frame; null: the hand is not tracked. */
  readonly palms: Readonly<Record<Side, Vec3 | null>>;
  /** 1: live; less: a ghost. */
  readonly opacity: number;
}

/** The result of one frame of the match, for view, sound and haptics. */
export interface BallFrame {
  readonly state: BallState;
  /** The epoch of the match's room, see `RoomView.epoch`. */
  readonly epoch: string;
  /** The phase of the connection. Unless it is joined, the state may be outdated. */
  readonly connection: ConnectionStatus['phase'];
  /** Seconds of the match. */
  readonly time: number;
  /** Seconds until the bell; after a match, the seconds that were left at its end. */
  readonly secondsLeft: number;
  readonly me: number | null;
  readonly role: BallRole | null;
  readonly spectators: number;
  /** A player has paused the match's clock. */
  readonly paused: boolean;
  readonly players: readonly (PlayerFrame | null)[];
  readonly bodies: readonly RemotePerson[];
  /** The basket where its holder's hands had it last; null: where the state has it. Arena frame. */
  readonly opening: Opening | null;
  readonly events: readonly BallEvent[];
  /** The page was hidden before this frame, and the events are from that time: their sounds are over. */
  readonly resumed: boolean;
  readonly cues: readonly BallCue[];
  readonly haptics: readonly HapticPulse[];
  readonly held: Readonly<Record<Side, number | null>>;
  /** How the ball in the own hand would fly, arena frame; null: no one aims it with a mouse. */
  readonly aim: Launch | null;
}
