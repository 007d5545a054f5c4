/** The angle [rad] in [−π, π] that differs from this one by whole turns. */
export const wrapAngle = (angle: number): number => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
