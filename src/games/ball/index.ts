// "threepoint-games/ball": rules, gestures, players and rooms of the ball game.
export type { BallBot } from './ball-bot';
export type { BallConnection, BallRoomView } from './ball-client';
export { ballClientPolicy, createBallLoopbackHost } from './ball-client';
export { ballKind } from './ball-messages';
export type { BallGame } from './ball-policy';
export { BallPolicy } from './ball-policy';
export type { BallTerms } from './ball-room-kind';
export type { BallEvent, BallInput, BallPlace, BallRole, BallState, Refusal, TimedLaunch } from './ball-state';
export type { Opening } from './basket';
export { basketDepth, basketInHands, basketRadius, landsIn, rimTube } from './basket';
export { ballInAir, ballRadius } from './flight';
export type { BallCue, BallGestureFrame } from './gestures';
export { BallGestures } from './gestures';
export type { PlayerBody } from './player-postures';
export { ballRules, defaultBallOptions } from './rules';
export { ballRulesText } from './rules-text';
export { createSimulatedHolder } from './simulated-holder';
export { createSimulatedThrower } from './simulated-thrower';
export { ballPosition, ballSecondsLeft, ballsLeft, catchesOf, displayedSeconds } from './state-selectors';
export {
  ballsPerRack,
  holderStation,
  isInZone,
  rackPosition,
  rotationForRound,
  stations,
  zoneRadius,
} from './stations';
export type { BallSteering, SteeredPlayer } from './steered-players';
export { createSteeredHolder, createSteeredThrower } from './steered-players';
