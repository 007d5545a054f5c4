/** The angle [rad] in [−π, π] that differs from this one by whole turns. */
export const wrapAngle = (angle: number): number => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));

/** The angle [rad] that differs from `angle` by whole turns and lies nearest to `before`. */
export const unwrapAngle = (angle: number, before: number): number => before + wrapAngle(angle - before);
