/** Where the truth stands: in the body, beside it, or nowhere. */
export const truthPlaces = ['inside', 'beside', 'off'] as const;
/** See truthPlaces. */
export type TruthPlace = (typeof truthPlaces)[number];
