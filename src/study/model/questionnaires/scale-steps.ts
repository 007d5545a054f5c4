/** Numbers at equal distances from one end to the other. */
export interface SteppedScale {
  readonly from: number;
  readonly to: number;
  readonly step: number;
}

/** Returns the number of steps from end to end, which is whole for a valid scale. */
export const stepsOf = ({ from, to, step }: SteppedScale): number => (to - from) / step;

/** Returns the number on a scale that is nearest to a value, ends included. */
export function nearestOn(scale: SteppedScale, value: number): number {
  const { from, step } = scale;
  const steps = Math.min(Math.round(stepsOf(scale)), Math.max(0, Math.round((value - from) / step)));
  return Number((from + steps * step).toFixed(6));
}

/** Returns every number on a scale in ascending order. */
export const pointsOn = (scale: SteppedScale): readonly number[] =>
  Array.from({ length: Math.round(stepsOf(scale)) + 1 }, (_, index) =>
    nearestOn(scale, scale.from + index * scale.step),
  );
