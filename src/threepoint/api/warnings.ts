import type { EstimatorName } from '../core/estimation/pose-estimator';

const warned = new WeakSet<object>();

/**
 * Warns once for each object that is used after its `dispose`; it does not throw, because frames call it. `what`: the
 * name of the class, which minifiers change.
 */
export const warnAfterDispose = (object: object, what: string): void =>
  warnOnce(object, `“update” has no effect after “dispose”. Stop calling it, or create another ${what}.`);

/** Warns once for each renderer that does not draw in the session it has. */
export const warnOfXrDisabled = (renderer: object): void =>
  warnOnce(renderer, 'the renderer has a session and does not draw in it. Set renderer.xr.enabled = true.');

/** Warns once that a page's policy lets no worker check files of avatars. */
export const warnOfThreadCheck = (): void =>
  warnOnce(
    warned,
    'no worker starts to check avatars of others, and frames wait for the check. Allow it: worker-src blob:.',
  );

function warnOnce(about: object, sentence: string): void {
  if (warned.has(about)) return;
  warned.add(about);
  console.warn(`threepoint: ${sentence}`);
}

/** Warns that inverse kinematics replaces the selected estimator, for a page that does not report it. */
export function warnOfFallback({
  estimator,
  reason,
}: {
  readonly estimator: EstimatorName;
  readonly reason: string;
}): void {
  console.warn(
    `threepoint: inverse kinematics draws the body instead of “${estimator}”: ${reason}. To report it yourself, prevent the default of “fallback”.`,
  );
}
