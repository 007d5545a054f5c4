// "threepoint-games/ball": rules, gestures, players and rooms of the ball game.
export type { BallBot } from './ball-bot';
export { type BallConnection, type BallRoomView, ballClientPolicy, createBallLoopbackHost } from './ball-client';
export { ballKind } from './ball-messages';
export { type BallGame, BallPolicy } from './ball-policy';
export type { BallTerms } from './ball-room-kind';
export type { BallEvent, BallInput, BallLocation, BallRole, BallState, Refusal, TimedLaunch } from './ball-state';
export { basketDepth, basketInHands, basketRadius, landsIn, type Opening, rimTube } from './basket';
export { ballInAir, ballRadius } from './flight';
export { type BallCue, type BallGestureFrame, BallGestures } from './gestures';
export type { PlayerBody } from './player-postures';
export { ballRules, ballRulesText, defaultBallOptions } from './rules';
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
export { type BallSteering, createSteeredHolder, createSteeredThrower, type SteeredPlayer } from './steered-players';
