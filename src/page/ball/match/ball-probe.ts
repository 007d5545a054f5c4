import { length } from 'threepoint/math';
import { type BallConnection, type BallLocation, ballsLeft, catchesOf } from 'threepoint-games/ball';
import type { BallFrame } from './ball-frame';

/** Returns the state of a match as plain data, for tests and tools. */
export function probeOf(
  { state, secondsLeft, me, role, spectators, paused, held, aim, players, opening }: BallFrame,
  connection: BallConnection,
) {
  const count = (on: BallLocation['on']) => state.balls.filter((location) => location.on === on).length;
  const { x, y, z } = opening?.position ?? state.basket.position;
  return {
    name: 'ball' as const,
    phase: state.phase,
    end: state.end,
    score: state.score,
    ballsLeft: ballsLeft(state),
    secondsLeft,
    /** Own seat; null: a spectator. */
    seat: me,
    role,
    ready: me !== null && (state.players[me]?.ready ?? false),
    rotate: state.rotate,
    spectators,
    paused,
    held,
    /** How fast the ball would leave the hand that a mouse aims [m/s]; null: it aims none. */
    aim: aim && length(aim.velocity),
    /** The number of balls that the user's own throws have brought into the basket. */
    caught: me === null ? 0 : catchesOf(state, me),
    connection: connection.status.phase,
    /** Rounds cut short because the room had forgotten them. */
    voided: connection.room?.voidedRounds ?? 0,
    /** How often the room has taken this page in: once, and again after each connection that was lost. */
    welcomes: connection.room?.welcomeCount ?? 0,
    /** How many balls are at each kind of location. */
    balls: {
      rack: count('rack'),
      hand: count('hand'),
      air: count('air'),
      floor: count('floor'),
      basket: count('basket'),
    },
    /** The middle of the opening, arena frame [m]. */
    basket: [x, y, z] as const,
    people: players.map((player) => player && { name: player.name, bot: player.bot, presence: player.presence }),
  };
}

export type BallProbe = ReturnType<typeof probeOf>;
