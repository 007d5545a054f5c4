import {
  type ClientPolicy,
  type Connection,
  LoopbackHost,
  type LoopbackOptions,
  type RoomView,
} from 'threepoint-rooms/room';
import { ballKind, ballRoomMessageFrom } from './ball-messages';
import { type BallGame, BallPolicy } from './ball-policy';
import { unpackBall } from './ball-snapshot';
import type { BallOptions } from './ball-state';
import { answersBallAction, applyBallEvent, predictBallAction, withMatchTime } from './client-state';
import { arenaFromSeatFloor } from './stations';

export type BallConnection = Connection<BallGame>;
export type BallRoomView = RoomView<BallGame>;
type BallLoopbackHost = LoopbackHost<BallGame>;

export const ballClientPolicy: ClientPolicy<BallGame> = {
  kind: ballKind,
  readMessage: ballRoomMessageFrom,
  unpack: unpackBall,
  follow: applyBallEvent,
  at: withMatchTime,
  predict: predictBallAction,
  answers: answersBallAction,
  arenaFromFloor: arenaFromSeatFloor,
};

export interface BallLoopbackOptions extends LoopbackOptions<BallGame> {
  readonly seed?: number;
  readonly ball?: Partial<BallOptions>;
}

/** Creates a Room of the ball game in this page. */
export const createBallLoopbackHost = ({ seed = 0, ball, ...options }: BallLoopbackOptions = {}): BallLoopbackHost =>
  new LoopbackHost(new BallPolicy({ ...ball, seed }), ballClientPolicy, options);
