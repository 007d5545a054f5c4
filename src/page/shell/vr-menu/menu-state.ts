import type { BodySolver } from 'threepoint';
import type { Notices } from 'threepoint-ui';
import type { ActivityMenu, MenuSheet } from '../../activity/activity-menu';
import type { Activities } from '../activities/activities';
import type { CalibrationControl } from '../controls/calibration-control';
import type { Headset } from '../headset';
import type { Settings } from '../settings';
import type { VrMenuState } from './menu-buttons';

/** The parts of the page that the menu in the headset shows. */
export interface MenuParts {
  readonly body: Pick<BodySolver, 'estimator' | 'unavailableEstimators'>;
  readonly settings: Settings;
  readonly activities: Pick<Activities, 'all' | 'current'>;
  readonly measuring: Pick<CalibrationControl, 'step'>;
  readonly notices: Pick<Notices, 'current'>;
  readonly headset: Pick<Headset, 'passthrough' | 'passthroughOffered'>;
}

/** The menu of an activity that has none. */
const noMenu: ActivityMenu = { entries: [], sheet: null, notice: null, hint: null };

/** Returns the current state of the menu in the headset. `sheet`: the shell's own page in place of it; null: none. */
export function menuStateOf(parts: MenuParts, sheet: MenuSheet | null): VrMenuState {
  const { body, settings, activities, measuring, notices, headset } = parts;
  const activity = activities.current && (activities.current.menu?.() ?? noMenu);
  return {
    estimator: body.estimator,
    unavailable: body.unavailableEstimators,
    calibration: measuring.step,
    overlay: settings.vrOverlay,
    deviceBody: settings.deviceBody,
    nextPassthrough: headset.passthroughOffered ? settings.passthrough : null,
    beside: headset.passthrough ? settings.beside : null,
    inPassthrough: headset.passthrough !== null,
    builtInBody: settings.builtInBody,
    skinTone: settings.skinTone,
    places: activities.all.map(({ name, title }) => ({ name, title })),
    activity,
    sheet: sheet ?? activity?.sheet ?? null,
    notice: activity?.notice ?? notices.current().at(-1)?.text ?? activity?.hint ?? null,
  };
}
