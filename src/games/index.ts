// "threepoint-games": what both games share.
export type { Launch } from './ballistics';
export { fallTime, positionAt, velocityAt } from './ballistics';
export { pulseBothHands } from './both-hands-pulse';
export { ballInPalm, wristAround } from './fist';
export type { Match } from './match';
export { createMatch } from './match';
export type { SimulatedInput } from './simulated-input';
