// "threepoint-games/archery": rules, gestures and players of archery.
export { aimOf, landingPointOf } from './aim-point';
export type { ArcheryAction, ArcheryEvent, ArcheryState, Arrow, BowView, Landing, Target } from './archery-state';
export { arrowLength, braceHeight, maximumDraw } from './bow';
export { bowInHand } from './bow-pose';
export { ArcheryGestures, type BowCue } from './gestures';
export {
  archeryRules,
  archeryRulesText,
  delayed,
  fullScore,
  isArmed,
  matchTime,
  secondsLeft,
  walls,
  zone,
} from './rules';
export { createSimulatedArcher, type SimulatedArcher } from './simulated-archer';
export { createSteeredArcher, type SteeredArcher } from './steered-archer';
