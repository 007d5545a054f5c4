import {
  type BuiltInBody,
  builtInBodies,
  defaultAvatar,
  type EstimatorName,
  type SkinTone,
  skinTones,
} from 'threepoint/core';
import { bodyLabelOf } from 'threepoint/internal/three';
import type { CalibrationStep } from 'threepoint-ui';
import {
  type ActivityMenu,
  bottomButton,
  fullWidth,
  inColumns,
  type MenuButton,
  type MenuEntry,
  type MenuSheet,
  menuMargin,
} from '../../../activity/activity-menu';
import { home } from '../../activity-registry';
import { estimatorTexts, listedEstimators } from '../../session/estimator-texts';
import { exitLabel } from '../panel-state';

export interface VrMenuState {
  readonly estimator: EstimatorName;
  readonly unavailable: Partial<Readonly<Record<EstimatorName, string>>>;
  readonly calibration: CalibrationStep | null;
  readonly overlay: boolean;
  readonly deviceBody: boolean;
  /** The next session shows the room around the user; null: the headset cannot. */
  readonly nextPassthrough: boolean | null;
  /** The avatar stands beside its user; null: the room is not seen. */
  readonly beside: boolean | null;
  /** The session shows the room around the user. */
  readonly inPassthrough: boolean;
  /** The built-in avatar that is worn, or would be instead of another one. */
  readonly builtInBody: BuiltInBody;
  /** The skin tone of a human avatar; undefined: the avatar's own. */
  readonly skinTone: SkinTone | undefined;
  /** The user holds controllers, whose grip can be corrected. */
  readonly holdsControllers: boolean;
  /** The activities that the user can go to, with the labels of their buttons. */
  readonly places: readonly { readonly name: string; readonly title: string }[];
  /** The part of the current activity; null: the user is at the mirror. */
  readonly activity: Pick<ActivityMenu, 'entries'> | null;
  /** A page that replaces the menu; null: the menu itself is shown. */
  readonly sheet: MenuSheet | null;
  /** A sentence at the bottom of the menu; null: none. */
  readonly notice: string | null;
}

export interface VrMenuActions {
  chooseEstimator(name: EstimatorName): void;
  calibrate(): void;
  cancelCalibration(): void;
  recentre(): void;
  openComfort(): void;
  openGrip(): void;
  setOverlay(on: boolean): void;
  setPassthrough(on: boolean): void;
  setBeside(on: boolean): void;
  goTo(place: string): void;
  chooseBuiltInBody(name: BuiltInBody): void;
  chooseSkinTone(tone: SkinTone): void;
  exit(): void;
}

/** Below the buttons: notices [pixels from the top]. */
export const noticesTop = 1012;

/** The top of the list of estimators, and its height [pixels]. */
const estimatorsTop = 116;
const estimatorsHeight = 404;
const estimatorGap = 12;
/** The top of all other buttons [pixels]. */
const entriesTop = 560;

const isOver = ({ kind }: CalibrationStep): boolean => kind === 'done' || kind === 'failed';

function estimatorButtons(
  { estimator, unavailable, deviceBody }: VrMenuState,
  actions: VrMenuActions,
): readonly MenuButton[] {
  const offered = listedEstimators.filter((name) => deviceBody || name !== 'device');
  const each = (estimatorsHeight + estimatorGap) / offered.length;
  return offered.map((name, index) => ({
    id: name,
    label: estimatorTexts[name].label,
    at: [menuMargin, estimatorsTop + index * each, fullWidth, each - estimatorGap],
    look: unavailable[name] !== undefined ? 'off' : name === estimator ? 'chosen' : 'plain',
    act: () => actions.chooseEstimator(name),
  }));
}

/** Returns the next value of a button that cycles through all values. */
const after = <T>(all: readonly [T, ...T[]], chosen: T | undefined): T =>
  all[chosen === undefined ? 0 : all.indexOf(chosen) + 1] ?? all[0];

/** The buttons that change with the place where the user is. */
function placeEntries(state: VrMenuState, actions: VrMenuActions): readonly MenuEntry[] {
  const { places, activity, builtInBody, skinTone, beside, nextPassthrough } = state;
  if (activity) return [{ id: home, label: 'To the mirror', act: () => actions.goTo(home) }, ...activity.entries];
  const entries = places.map(({ name, title }) => ({ id: name, label: title, act: () => actions.goTo(name) }));
  if (beside !== null) {
    const label = beside ? 'Back into your body' : 'Stand beside yourself';
    entries.push({ id: 'beside', label, act: () => actions.setBeside(!beside) });
  }
  if (nextPassthrough !== null) {
    const label = nextPassthrough ? 'Next session: AR' : 'Next session: VR';
    entries.push({ id: 'passthrough', label, act: () => actions.setPassthrough(!nextPassthrough) });
  }
  const body = `Body: ${bodyLabelOf(builtInBody)}`;
  entries.push({ id: 'body', label: body, act: () => actions.chooseBuiltInBody(after(builtInBodies, builtInBody)) });
  if (builtInBody === defaultAvatar) return entries;
  const skin = `Skin: ${skinTone ?? 'own'}`;
  return [...entries, { id: 'skin', label: skin, act: () => actions.chooseSkinTone(after(skinTones, skinTone)) }];
}

/** Returns the buttons of the menu, at least as large as a palm. They are lower if there are many. */
export function menuButtons(state: VrMenuState, actions: VrMenuActions): readonly MenuButton[] {
  if (state.calibration)
    return [bottomButton('cancel', isOver(state.calibration) ? 'Close' : 'Cancel', () => actions.cancelCalibration())];
  if (state.sheet) return state.sheet.buttons;
  const overlay = state.overlay ? 'Hide frame times' : 'Frame times';
  const entries: readonly MenuEntry[] = [
    { id: 'calibrate', label: 'Calibrate', act: () => actions.calibrate() },
    { id: 'recentre', label: 'Centre', act: () => actions.recentre() },
    { id: 'comfort', label: 'Comfort', act: () => actions.openComfort() },
    ...(state.holdsControllers ? [{ id: 'grip', label: 'My grip', act: () => actions.openGrip() }] : []),
    { id: 'overlay', label: overlay, act: () => actions.setOverlay(!state.overlay) },
    { id: 'exit', label: exitLabel(state.inPassthrough), act: () => actions.exit() },
    ...placeEntries(state, actions),
  ];
  const each = Math.min(112, Math.floor((noticesTop - entriesTop) / Math.ceil(entries.length / 2)));
  return [...estimatorButtons(state, actions), ...inColumns(entries, entriesTop, each)];
}
