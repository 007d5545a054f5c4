import {
  type Buttons,
  type Calibration,
  chestSpaceBody,
  type PoseEstimator,
  type TrackingFrame,
} from 'threepoint/core';
import { fingersFromButtons } from 'threepoint/internal/three';
import { identity, zero } from 'threepoint/math';
import type { SimulatedInput } from 'threepoint-games';
import {
  type BallBot,
  type BallConnection,
  type BallGestureFrame,
  BallGestures,
  type BallInput,
  type BallRoomView,
  type BallState,
  ballClientPolicy,
  createSimulatedHolder,
  createSimulatedThrower,
  holderStation,
  type Opening,
  type PlayerBody,
  stations,
} from 'threepoint-games/ball';

/** The least rate at which a simulated player moves, even if pictures are slower: a throw takes a fifth of a second. */
const movesPerSecond = 60;
/** After a longer gap than this [s] nothing is caught up. */
const longestCatchUp = 1;

/** Returns the moments since the last one at which a simulated player moves; the last is now. */
export function stepTimes(time: number, last: number | null): readonly number[] {
  const passed = last === null ? 0 : time - last;
  if (passed > longestCatchUp) return [time];
  const count = Math.max(1, Math.floor(passed * movesPerSecond));
  const moments: number[] = [];
  for (let i = 0; i < count; i++) moments.push(time - (passed * (count - 1 - i)) / count);
  return moments;
}

const isHandAction = (action: BallInput): action is Extract<BallInput, { type: 'grab' | 'drop' | 'throw' }> =>
  action.type === 'grab' || action.type === 'drop' || action.type === 'throw';

export const bodyAt = (station: number, calibration: Calibration): PlayerBody => ({
  eyeHeight: calibration.eyeHeight,
  armLength: chestSpaceBody(calibration).arm,
  arenaFromFloor: stations[station] ?? { position: zero, orientation: identity },
});

/** Creates the simulated player of a station. `seed`: for the scatter of its throws. */
export function createSimulatedPlayer(station: number, calibration: Calibration, seed: number): BallBot {
  const body = bodyAt(station, calibration);
  return station === holderStation ? createSimulatedHolder(body) : createSimulatedThrower(body, seed + 31 * station);
}

/** What simulated players know about the court in addition to the state of the match. */
export interface BotKnowledge {
  /** The total time for which the match's clock was paused [s]: simulated players stand still meanwhile. */
  pausedSeconds: number;
  opening: Opening | null;
}

/** Creates the gestures of the player on this connection. */
export function createGestures(of: BallConnection): BallGestures {
  return new BallGestures(() => {
    const seen = of.room;
    const seat = seen?.mySeat ?? 0;
    return {
      player: seat,
      // Asked only while there is a match: see `play`.
      state: seen?.match as BallState,
      arenaFromFloor: of.arenaFromFloor(seat),
      matchAhead: seen?.matchClockOffset ?? 0,
    };
  });
}

/** Sends the actions of a player's frame. While the clock is paused, hands do nothing. */
export function playFrame(
  of: BallConnection,
  gestures: BallGestures,
  frame: TrackingFrame,
  buttons: Buttons,
): BallGestureFrame {
  const done = gestures.follow(of.room?.paused ? { ...frame, suspended: true } : frame, buttons);
  for (const action of done.actions) {
    if (!isHandAction(action)) continue;
    const { player: _, ...ownAction } = action;
    of.sendAction(ownAction);
  }
  return done;
}

export const stationOf = (seen: BallRoomView, seat: number): number => seen.match?.players[seat]?.station ?? seat;

/** Returns head, hands and buttons of a simulated player. Its own time stops while the match is paused. */
export function simulatedInput(
  actor: BallBot,
  time: number,
  state: BallState,
  player: number,
  { pausedSeconds, opening }: BotKnowledge,
): SimulatedInput {
  const done = actor.follow(time - pausedSeconds, { state, player, ...(opening && { basket: opening.position }) });
  return pausedSeconds === 0 ? done : { ...done, frame: { ...done.frame, time } };
}

/** A simulated player on a connection, and the estimator that solves its body. */
interface SimulatedSeat {
  readonly connection: BallConnection;
  readonly gestures: BallGestures;
  readonly player: BallBot;
  readonly estimator: PoseEstimator;
}

/** Plays one moment of a simulated player: sends its actions and its solved body. */
export function stepSimulated(
  { connection, gestures, player, estimator }: SimulatedSeat,
  moment: number,
  sight: BotKnowledge,
): BallGestureFrame | null {
  const seen = connection.room;
  if (!seen?.match || seen.mySeat === null) return null;
  // The player decides by the time of the moment: by that of the picture, its turns to throw would pass between two.
  const state = ballClientPolicy.at(seen.match, moment + seen.matchClockOffset);
  const { frame, buttons } = simulatedInput(player, moment, state, seen.mySeat, sight);
  const { pose } = estimator.update(frame);
  connection.sendPose(moment, { jump: false, pose, fingers: fingersFromButtons(buttons) });
  return playFrame(connection, gestures, frame, buttons);
}
