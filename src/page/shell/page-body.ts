import { BodySolver, type CalibrationSource } from 'threepoint';
import { type Calibration, createPageClock, firstLine } from 'threepoint/core';
import { Emitter } from './emitter';
import { estimatorTexts } from './estimator-texts';
import type { FrameTiming } from './frame-timing';
import { createNetworkLoader } from './network-loading';
import type { PageContext } from './page-context';
import type { PageLoading } from './page-loading';

/**
 * Creates the body that head and hands move, with its networks and clock, and the events that other parts of the page
 * listen to.
 */
export function createPageBody(context: PageContext, loading: PageLoading, timing: FrameTiming) {
  const { switches, store, changes, notices } = context;
  const clock = createPageClock(() => performance.now());
  const calibrated = new Emitter<[calibration: Calibration, source: CalibrationSource]>();
  /** The user is taller than their calibration by this much [m]. */
  const outgrown = new Emitter<[difference: number]>();
  const discontinuity = new Emitter();
  const networks = createNetworkLoader({ provider: switches.executionProvider, notices, loading });
  const body = new BodySolver({
    estimator: 'ik',
    calibration: store.preferences.calibration ?? 'auto',
    // A study measures its participants itself.
    autoGrow: switches.study === null,
    networks,
    clock,
    profiler: timing,
    events: {
      calibrated: calibrated.emit,
      heightmismatch: outgrown.emit,
      discontinuity: discontinuity.emit,
      estimatorchange: changes.emit,
      fallback(name, reason) {
        const { label } = estimatorTexts[name];
        notices.show(
          'warning',
          `${label} could not be used, so inverse kinematics takes over. Reason: ${firstLine(reason)}`,
        );
      },
    },
  });
  return { body, networks, clock, bodyEvents: { calibrated, outgrown, discontinuity } };
}
