import type { EstimatorName } from '../core/estimation/pose-estimator';

const warned = new WeakSet<object>();

/**
 * Warns once for each object that is used after its `dispose`; it does not throw, because frames call it. `what`: the
 * name of the class, which minifiers change.
 */
export function warnAfterDispose(object: object, what: string): void {
  if (warned.has(object)) return;
  warned.add(object);
  console.warn(`threepoint: “update” has no effect after “dispose”. Stop calling it, or create another ${what}.`);
}

/**
 * Warns that inverse kinematics replaces the selected estimator, for a page without a handler. `handler`: the handler's
 * name.
 */
export function warnOfFallback(
  { estimator, reason }: { readonly estimator: EstimatorName; readonly reason: string },
  handler = 'fallback',
): void {
  console.warn(
    `threepoint: inverse kinematics draws the body instead of “${estimator}”: ${reason}. Handle “${handler}” to report it yourself.`,
  );
}
