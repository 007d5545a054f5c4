/** The places of the ground truth: inside the body, beside it, or hidden. */
export const truthPlaces = ['inside', 'beside', 'off'] as const;
export type TruthPlace = (typeof truthPlaces)[number];
