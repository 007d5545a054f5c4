import type { ActivityMenu, MenuSheet } from '../../../activity/activity-menu';
import type { CalibrationControl } from '../../input/calibration-control';
import type { StageParts } from '../../stage/stage-parts';
import type { VrMenuState } from './menu-buttons';

/** The menu of an activity that has none. */
const noMenu: ActivityMenu = { entries: [], sheet: null, notice: null, hint: null };

/** Returns the current state of the menu in the headset. `sheet`: the shell's own page in place of it; null: none. */
export function menuStateOf(
  { body, settings, activities, notices, headset }: StageParts,
  measuring: CalibrationControl,
  sheet: MenuSheet | null,
): VrMenuState {
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
