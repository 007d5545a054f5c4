/** Kinds of files that `exportMotion` makes by itself. */
export const motionFormats = ['bvh', 'csv', 'vrma'] as const;
export type MotionFormat = (typeof motionFormats)[number];
