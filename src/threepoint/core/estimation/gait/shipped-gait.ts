import type { GaitNetwork } from './gait';
import shipped from './gait-network.json' with { type: 'json' };

/** The gait network of the drawn legs, in a module that loads with the first avatar. */
export const shippedGait: GaitNetwork = shipped;
