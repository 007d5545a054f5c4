// "threepoint-games/archery": rules, gestures and players of archery.
export { aimOf } from './aim-point';
export type { ArcheryAction, ArcheryEvent, ArcheryState, Arrow, BowView, Landing, Target } from './archery-state';
export { arrowLength, braceHeight, maximumDraw } from './bow';
export { bowInHand } from './bow-pose';
export type { BowCue } from './gestures';
export { ArcheryGestures } from './gestures';
export { archeryRules, delayed, fullScore, isArmed, matchTime, secondsLeft, walls, zone } from './rules';
export { archeryRulesText } from './rules-text';
export type { SimulatedArcher } from './simulated-archer';
export { createSimulatedArcher } from './simulated-archer';
export type { SteeredArcher } from './steered-archer';
export { createSteeredArcher } from './steered-archer';
