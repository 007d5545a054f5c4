import { labelOf } from 'threepoint/avatar/own-bodies';
import { type OwnBody, ownBodies, plainAvatar, type SkinTone, skinTones } from 'threepoint/core/body/avatar-ref';
import type { EstimatorName } from 'threepoint/core/estimation/pose-estimator';
import type { Side } from 'threepoint/core/math/side';
import type { CalibrationStep } from 'threepoint-ui/calibration-dialog';
import type { RoomLink } from 'threepoint-ui/invitation';
import type { QrCode } from 'threepoint-ui/qr-code';
import { hideLabel, muteLabel, type OtherPlayer } from '../../ball/other-players';
import type { VoicesState } from '../../ball/voices-state';
import { estimatorOrder, estimatorTexts } from '../estimator-texts';
import type { ActivityName } from '../play-bar';

/** The way into a room, held up for others. */
export interface ShownInvitation extends RoomLink {
  readonly code: QrCode | 'loading' | 'not to be had';
}

/** What the menu in the headset shows. */
export interface VrMenuState {
  readonly estimator: EstimatorName;
  readonly unavailable: Partial<Readonly<Record<EstimatorName, string>>>;
  readonly calibration: CalibrationStep | null;
  readonly overlay: boolean;
  /** The device was asked for its own body. */
  readonly deviceBody: boolean;
  readonly activity: ActivityName;
  /** Which of our bodies is worn, or would be in place of another avatar. */
  readonly ownBody: OwnBody;
  /** Of people among them; undefined: the one that the body comes with. */
  readonly skinTone: SkinTone | undefined;
  /** Whether others are shown as mannequins. */
  readonly plainOthers: boolean;
  readonly bowSide: Side;
  readonly roundOver: boolean;
  /** In the ball game, before and after a match: whether one is ready; null: not asked. */
  readonly ready: boolean | null;
  /** How one takes part in the voices of a room; none: it has none. */
  readonly voices: Pick<VoicesState, 'phase' | 'muted' | 'deaf'>;
  /** Who else is in the room of the ball game, and whether their list is held up in place of everything else. */
  readonly others: readonly OtherPlayer[];
  readonly listed: boolean;
  /** Others can come into the room of the ball game. */
  readonly canInvite: boolean;
  /** In place of everything else; null: not now. */
  readonly invitation: ShownInvitation | null;
  /** A sentence to be read in the headset; null: none. */
  readonly notice: string | null;
}

export interface VrMenuActions {
  chooseEstimator(name: EstimatorName): void;
  calibrate(): void;
  cancelCalibration(): void;
  recentre(): void;
  setOverlay(on: boolean): void;
  goTo(activity: ActivityName): void;
  chooseOwnBody(name: OwnBody): void;
  chooseSkinTone(tone: SkinTone): void;
  setPlainOthers(on: boolean): void;
  setBowSide(side: Side): void;
  restart(): void;
  ready(on: boolean): void;
  /** What voices mean is to be read, or no longer. */
  askVoices(on: boolean): void;
  joinVoices(): void;
  mute(on: boolean): void;
  /** Who else is here is to be seen, or no longer. */
  listOthers(on: boolean): void;
  /** Does not hear a player any more, or does again. */
  silence(seat: number, on: boolean): void;
  /** Neither sees nor hears a player any more, or does again. */
  hide(seat: number, on: boolean): void;
  invite(on: boolean): void;
  exit(): void;
}

export interface MenuButton {
  readonly id: string;
  readonly label: string;
  /** Left, top, width and height on the sheet [pixels]. */
  readonly at: readonly [number, number, number, number];
  readonly look: 'plain' | 'chosen' | 'off';
  readonly act: () => void;
}

/** The sheet, and what is left free at its edges [pixels]. */
export const menuWidth = 640;
export const menuHeight = 1112;
export const menuMargin = 36;
/** Below the buttons: notices [pixels from the top]. */
export const noticesTop = 1012;

/** Where the methods stand, as many as there are [pixels]. */
const estimatorsTop = 116;
const estimatorsHeight = 404;
const estimatorGap = 12;
/** Where everything else begins that can be pressed [pixels]. */
const entriesTop = 560;

/** Where the first of the other players stands, and how high one is: name, role and voice, two buttons [pixels]. */
export const othersTop = 124;
export const otherHeight = 252;
const otherButtonsTop = 104;
const otherButtonsHeight = 88;

const full = menuWidth - 2 * menuMargin;
const gap = 16;
const half = (full - gap) / 2;

type Entry = readonly [id: string, label: string, act: () => void];

/** The one button of a sheet that shows something else than the menu. */
const onlyButton = (id: string, label: string, act: () => void): MenuButton => ({
  id,
  label,
  at: [menuMargin, menuHeight - menuMargin - 96, full, 96],
  look: 'plain',
  act,
});

/** What can be done about each of the other players: one row for each, the same at the same place in all. */
function otherButtons({ others }: VrMenuState, actions: VrMenuActions): readonly MenuButton[] {
  return others.flatMap((player, row): MenuButton[] => {
    const { seat, silenced, hidden, muting } = player;
    const top = othersTop + row * otherHeight + otherButtonsTop;
    const hide: MenuButton = {
      id: `hide-${seat}`,
      label: hideLabel(player),
      at: [menuMargin + half + gap, top, half, otherButtonsHeight],
      look: hidden ? 'chosen' : 'plain',
      act: () => actions.hide(seat, !hidden),
    };
    if (muting === 'none') return [hide];
    const mute: MenuButton = {
      id: `mute-${seat}`,
      label: muteLabel(player),
      at: [menuMargin, top, half, otherButtonsHeight],
      look: muting === 'off' ? 'off' : silenced ? 'chosen' : 'plain',
      act: () => actions.silence(seat, !silenced),
    };
    return [mute, hide];
  });
}

const isOver = ({ kind }: CalibrationStep): boolean => kind === 'done' || kind === 'failed';

function estimatorButtons(
  { estimator, unavailable, deviceBody }: VrMenuState,
  actions: VrMenuActions,
): readonly MenuButton[] {
  const offered = estimatorOrder.filter((name) => deviceBody || name !== 'device');
  const each = (estimatorsHeight + estimatorGap) / offered.length;
  return offered.map((name, index) => ({
    id: name,
    label: estimatorTexts[name].label,
    at: [menuMargin, estimatorsTop + index * each, full, each - estimatorGap],
    look: unavailable[name] !== undefined ? 'off' : name === estimator ? 'chosen' : 'plain',
    act: () => actions.chooseEstimator(name),
  }));
}

/** What a button brings that goes round: after the last the first. */
const after = <T>(all: readonly [T, ...T[]], chosen: T | undefined): T =>
  all[chosen === undefined ? 0 : all.indexOf(chosen) + 1] ?? all[0];

/** What one can do about voices now. */
function voiceEntries({ voices: { phase, muted, deaf } }: VrMenuState, actions: VrMenuActions): readonly Entry[] {
  switch (phase) {
    case 'off':
      return [['voices', 'Talk', () => actions.askVoices(true)]];
    case 'asked':
      return [
        ['voices', 'Join, muted', () => actions.joinVoices()],
        ['no-voices', 'Not now', () => actions.askVoices(false)],
      ];
    case 'in':
      return [['voices', deaf ? 'No microphone' : muted ? 'Unmute me' : 'Mute me', () => actions.mute(!muted)]];
    default:
      return [];
  }
}

/** Where one can go from here, and what one can do here. */
function playEntries(state: VrMenuState, actions: VrMenuActions): readonly Entry[] {
  const { activity, ready, roundOver, bowSide, ownBody, skinTone, plainOthers } = state;
  const studio: Entry = ['studio', 'To the mirror', () => actions.goTo('studio')];
  if (activity === 'studio')
    return [
      ['archery', 'Archery', () => actions.goTo('archery')],
      ['ball', 'Ball game', () => actions.goTo('ball')],
      ['body', `Body: ${labelOf(ownBody)}`, () => actions.chooseOwnBody(after(ownBodies, ownBody))],
      ...(ownBody === plainAvatar
        ? []
        : [['skin', `Skin: ${skinTone ?? 'own'}`, () => actions.chooseSkinTone(after(skinTones, skinTone))] as const]),
    ];
  if (activity === 'ball')
    return [
      studio,
      ...(ready === null ? [] : [['ready', ready ? 'Wait for me' : 'Ready', () => actions.ready(!ready)] as const]),
      // What voices mean is read before anything else is pressed.
      ...(state.voices.phase === 'asked'
        ? []
        : [
            [
              'others',
              `Others: ${plainOthers ? 'plain' : 'as worn'}`,
              () => actions.setPlainOthers(!plainOthers),
            ] as const,
            ...(state.others.length > 0 ? [['players', 'Players', () => actions.listOthers(true)] as const] : []),
            ...(state.canInvite ? [['invite', 'Invite', () => actions.invite(true)] as const] : []),
          ]),
      ...voiceEntries(state, actions),
    ];
  if (roundOver) return [studio, ['restart', 'New round', () => actions.restart()]];
  const other = bowSide === 'left' ? 'right' : 'left';
  return [studio, ['bow', `Bow: ${bowSide} hand`, () => actions.setBowSide(other)]];
}

/** What can be pressed on the menu now; targets as big as a palm, lower ones where there are many. */
export function menuButtons(state: VrMenuState, actions: VrMenuActions): readonly MenuButton[] {
  if (state.calibration)
    return [onlyButton('cancel', isOver(state.calibration) ? 'Close' : 'Cancel', () => actions.cancelCalibration())];
  if (state.invitation) return [onlyButton('close', 'Close', () => actions.invite(false))];
  if (state.listed)
    return [...otherButtons(state, actions), onlyButton('close', 'Close', () => actions.listOthers(false))];
  const entries: readonly Entry[] = [
    ['calibrate', 'Calibrate', () => actions.calibrate()],
    ['recentre', 'Recentre', () => actions.recentre()],
    ['overlay', state.overlay ? 'Hide frame times' : 'Frame times', () => actions.setOverlay(!state.overlay)],
    ['exit', 'Exit VR', () => actions.exit()],
    ...playEntries(state, actions),
  ];
  const each = Math.min(112, Math.floor((noticesTop - entriesTop) / Math.ceil(entries.length / 2)));
  return [
    ...estimatorButtons(state, actions),
    ...entries.map(([id, label, act], index): MenuButton => {
      const x = menuMargin + (index % 2) * (half + gap);
      const y = entriesTop + Math.floor(index / 2) * each;
      return { id, label, at: [x, y, half, each - gap], look: 'plain', act };
    }),
  ];
}
