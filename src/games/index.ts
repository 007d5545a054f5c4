// "threepoint-games": what games share.
export { fallTime, type Launch, positionAt, velocityAt } from './ballistics';
export { pulseBothHands } from './both-hands-pulse';
export { ballInPalm, wristAround } from './fist';
export { createMatch, type Match } from './match';
export type { SimulatedInput } from './simulated-input';
