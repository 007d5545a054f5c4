/** The formats that `exportMotion` writes without a MotionWriter. */
export const motionFormats = ['bvh', 'csv', 'vrma'] as const;
export type MotionFormat = (typeof motionFormats)[number];
