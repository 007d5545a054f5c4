import { Vector3 } from 'three';
import { stations } from 'threepoint-games/ball/stations';
import type { OtherPlayer } from 'threepoint-page/ball/other-players';
import {
  menuButtons,
  menuHeight,
  menuMargin,
  menuWidth,
  type VrMenuActions,
  type VrMenuState,
} from 'threepoint-page/shell/vr-menu/menu-buttons';
import { drawMenu } from 'threepoint-page/shell/vr-menu/menu-drawing';
import { VrMenu } from 'threepoint-page/shell/vr-menu/vr-menu';
import { longestName } from 'threepoint-rooms/protocol/names';
import type { Pointer } from 'threepoint-ui/vr-pointers';
import { describe, expect, test } from 'vitest';
import { drawNowhere } from './drawing-in-node';

drawNowhere();

const player = (seat: number, change: Partial<OtherPlayer> = {}): OtherPlayer => ({
  ...{ seat, name: `Player ${seat}`, role: 'Right thrower', said: 'can be heard' },
  ...{ silenced: false, hidden: false, muting: 'offered' },
  ...change,
});
const ben = player(0, { name: 'Ben' });
const bot = player(2, { name: 'Kim (bot)', said: '', muting: 'none' });

/** The menu's state while the other players are listed. */
const listing = (...others: readonly OtherPlayer[]): VrMenuState => ({
  ...{ estimator: 'ik', unavailable: {}, calibration: null, overlay: false, deviceBody: false, activity: 'ball' },
  ...{ ownBody: 'mannequin', skinTone: undefined, plainOthers: false, bowSide: 'left', roundOver: false, ready: false },
  ...{ voices: { phase: 'in', muted: true, deaf: false }, canInvite: true, invitation: null, notice: 'Waiting.' },
  ...{ others, listed: true },
});

/** What is pressed is written down. */
function recorded() {
  const done: string[] = [];
  const nothing = () => undefined;
  const actions: VrMenuActions = {
    ...{ chooseEstimator: nothing, calibrate: nothing, cancelCalibration: nothing, recentre: nothing },
    ...{ setOverlay: nothing, goTo: nothing, chooseOwnBody: nothing, chooseSkinTone: nothing, invite: nothing },
    ...{ setPlainOthers: nothing, setBowSide: nothing, restart: nothing, ready: nothing, askVoices: nothing },
    ...{ joinVoices: nothing, mute: nothing, exit: nothing },
    listOthers: (on) => void done.push(`list ${on}`),
    silence: (seat, on) => void done.push(`silence ${seat} ${on}`),
    hide: (seat, on) => void done.push(`hide ${seat} ${on}`),
  };
  return { done, actions };
}

const shown = (...others: readonly OtherPlayer[]) =>
  menuButtons(listing(...others), recorded().actions).map(({ id, label, look }) => [id, label, look]);

describe('the other players in the headset', () => {
  test('have a button each to mute and to hide them; a bot, which has no voice, the second alone', () => {
    expect(shown(ben, bot)).toEqual([
      ['mute-0', 'Mute', 'plain'],
      ['hide-0', 'Hide', 'plain'],
      ['hide-2', 'Hide', 'plain'],
      ['close', 'Close', 'plain'],
    ]);
  });

  test('who are muted or hidden have lit buttons that take it back; a hidden one cannot be muted besides', () => {
    expect(shown({ ...ben, silenced: true })[0]).toEqual(['mute-0', 'Unmute', 'chosen']);
    expect(shown({ ...ben, hidden: true, muting: 'off' }).slice(0, 2)).toEqual([
      ['mute-0', 'Mute', 'off'],
      ['hide-0', 'Show', 'chosen'],
    ]);
  });

  test('a press asks for the other state of that player', () => {
    const { done, actions } = recorded();
    const heard = [ben, player(1, { silenced: true }), player(2, { hidden: true, muting: 'off' })];
    for (const { act, look } of menuButtons(listing(...heard), actions)) if (look !== 'off') act();
    expect(done).toEqual([
      ...['silence 0 true', 'hide 0 true', 'silence 1 false', 'hide 1 true', 'hide 2 false'],
      'list false',
    ]);
  });

  test('the buttons of all that a spectator sees lie apart and inside the sheet, as big as a palm', () => {
    const buttons = menuButtons(listing(...stations.map((_, seat) => player(seat))), recorded().actions);
    expect(buttons).toHaveLength(2 * stations.length + 1);
    for (const [index, { at }] of buttons.entries()) {
      const [x, y, w, h] = at;
      expect(Math.min(w, h)).toBeGreaterThanOrEqual(80);
      expect(Math.min(x, y, menuWidth - x - w, menuHeight - y - h)).toBeGreaterThanOrEqual(menuMargin);
      for (const { at: other } of buttons.slice(index + 1)) {
        const beside = other[0] >= x + w || other[0] + other[2] <= x;
        const below = other[1] >= y + h || other[1] + other[3] <= y;
        expect(beside || below).toBe(true);
      }
    }
  });

  test('are written above their buttons, with role and voice, no wider than the sheet', () => {
    const texts: { text: string; y: number; most: number | undefined }[] = [];
    const context = {
      ...{ font: '', fillStyle: '', textAlign: '', textBaseline: '', globalAlpha: 1, lineWidth: 1, strokeStyle: '' },
      ...{ beginPath: () => undefined, roundRect: () => undefined, fill: () => undefined, stroke: () => undefined },
      fillText: (text: string, _: number, y: number, most?: number) => void texts.push({ text, y, most }),
    } as unknown as CanvasRenderingContext2D;
    const long = player(1, { name: 'W'.repeat(longestName) });
    const state = listing(ben, long);
    const buttons = menuButtons(state, recorded().actions);
    drawMenu(context, state, buttons, null);
    const [{ text: heading } = { text: '' }] = texts;
    expect(heading).toBe('Other players');
    const written = (wanted: string) => texts.find(({ text }) => text === wanted);
    expect(written('Right thrower · can be heard')?.y).toBeGreaterThan(written('Ben')?.y ?? Number.NaN);
    expect(written(long.name)?.most).toBeLessThanOrEqual(menuWidth - 2 * menuMargin);
    for (const [id, name] of [['mute-0', 'Ben'] as const, ['mute-1', long.name] as const])
      expect(buttons.find((button) => button.id === id)?.at[1]).toBeGreaterThan(written(name)?.y ?? Number.NaN);
    // The menu's notices would lie below the buttons of a full list.
    expect(written('Waiting.')).toBeUndefined();
    texts.length = 0;
    drawMenu(context, listing(), menuButtons(listing(), recorded().actions), null);
    expect(texts.map(({ text }) => text)).toContain('No one else is here now.');
  });

  test('a finger tip that is put through a button presses it', () => {
    const { done, actions } = recorded();
    const menu = new VrMenu(actions);
    menu.setVisible(true);
    menu.show(listing(ben));
    const sheet = menu.object.children[0];
    const [x, y, w, h] = menuButtons(listing(ben), actions)[0]?.at ?? [0, 0, 0, 0];
    /** Hands whose rays point away from the sheet. */
    const hand = (): Pointer & { tip: Vector3 } => {
      const tip = new Vector3();
      return { origin: tip, direction: new Vector3(0, 1, 0), tip, pressed: false, showRay: () => undefined };
    };
    const [left, right] = [hand(), hand()];
    /** Puts a finger tip so far before the middle of the first button [m]. */
    const put = ({ tip }: { tip: Vector3 }, before: number) => {
      menu.object.updateWorldMatrix(true, true);
      tip.set((x + w / 2 - menuWidth / 2) / 1000, (menuHeight / 2 - y - h / 2) / 1000, before);
      sheet?.localToWorld(tip);
    };
    // A hand that was behind the sheet before has touched nothing, also where the other is no longer seen.
    put(left, 0.1);
    put(right, -0.03);
    menu.point([left, right]);
    menu.point([right]);
    expect(done).toEqual([]);
    for (const before of [0.1, 0.03, -0.01, -0.01]) {
      put(left, before);
      menu.point([left]);
    }
    expect(done).toEqual(['silence 0 true']);
  });
});
