import { Vector3 } from 'three';
import { MutablePointer } from 'threepoint/core';
import { up, zero } from 'threepoint/math';
import { stations } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { menuHeight, menuMargin, menuWidth } from '../../../../src/page/activity/activity-menu';
import { type PlayersSheetActions, playersSheet } from '../../../../src/page/people/menu/players-sheet';
import type { OtherPlayer } from '../../../../src/page/people/panel/other-players';
import {
  menuButtons,
  type VrMenuActions,
  type VrMenuState,
} from '../../../../src/page/shell/panels/vr-menu/menu-buttons';
import { drawMenu } from '../../../../src/page/shell/panels/vr-menu/menu-drawing';
import { VrMenu } from '../../../../src/page/shell/panels/vr-menu/vr-menu';
import { drawNowhere } from '../drawing-in-node';
import { expectApart, paper, studioMenu } from '../menu-parts';

drawNowhere();

const player = (seat: number, change: Partial<OtherPlayer> = {}): OtherPlayer => ({
  seat,
  name: `Player ${seat}`,
  station: seat,
  label: `${seat + 1} · Player ${seat}`,
  role: 'Right thrower',
  status: 'can be heard',
  voice: 'open',
  link: 'connected',
  silenced: false,
  hidden: false,
  muting: 'offered',
  ...change,
});
const ben = player(0, { name: 'Ben' });
const bot = player(2, { name: 'Kim (bot)', status: '', muting: 'none' });
const menuActions = {} as VrMenuActions;

/** Records every press. */
function recorded() {
  const done: string[] = [];
  const actions: PlayersSheetActions = {
    close: () => void done.push('close'),
    silence: (seat, on) => void done.push(`silence ${seat} ${on}`),
    hide: (seat, on) => void done.push(`hide ${seat} ${on}`),
  };
  return { done, actions };
}

/** The menu while it lists the other players. */
const listing = (others: readonly OtherPlayer[], { actions } = recorded()): VrMenuState => ({
  ...studioMenu,
  sheet: playersSheet(others, actions),
  notice: 'Waiting.',
});

const buttonsFor = (...others: readonly OtherPlayer[]) => menuButtons(listing(others), menuActions);
const shown = (...others: readonly OtherPlayer[]) =>
  buttonsFor(...others).map(({ id, label, look }) => [id, label, look]);

describe('the other players in the headset', () => {
  test('have a button each to mute and to hide; a bot, voiceless, the second alone', () => {
    expect(shown(ben, bot)).toEqual([
      ['mute-0', 'Mute', 'plain'],
      ['hide-0', 'Hide', 'plain'],
      ['hide-2', 'Hide', 'plain'],
      ['close', 'Close', 'plain'],
    ]);
  });

  test('have lit buttons that undo muting or hiding; a hidden one cannot be muted besides', () => {
    expect(shown({ ...ben, silenced: true })[0]).toEqual(['mute-0', 'Unmute', 'chosen']);
    expect(shown({ ...ben, hidden: true, muting: 'off' }).slice(0, 2)).toEqual([
      ['mute-0', 'Mute', 'off'],
      ['hide-0', 'Show', 'chosen'],
    ]);
  });

  test('a press asks for the other state of that player', () => {
    const { done, actions } = recorded();
    const others = [ben, player(1, { silenced: true }), player(2, { hidden: true, muting: 'off' })];
    for (const { act, look } of playersSheet(others, actions).buttons) if (look !== 'off') act();
    expect(done).toEqual([
      ...['silence 0 true', 'hide 0 true', 'silence 1 false', 'hide 1 true', 'hide 2 false'],
      'close',
    ]);
  });

  test('the buttons of everyone a spectator sees lie apart on the sheet, as big as palms', () => {
    const buttons = buttonsFor(...stations.map((_, seat) => player(seat)));
    expect(buttons).toHaveLength(2 * stations.length + 1);
    for (const { at } of buttons) {
      const [x, y, w, h] = at;
      expect(Math.min(w, h)).toBeGreaterThanOrEqual(80);
      expect(Math.min(x, y, menuWidth - x - w, menuHeight - y - h)).toBeGreaterThanOrEqual(menuMargin);
    }
    expectApart(buttons);
  });

  test('are written above their buttons, with role and voice, no wider than the sheet', () => {
    const { context, texts } = paper();
    const long = player(1, { name: 'W'.repeat(20) });
    const state = listing([ben, long]);
    const buttons = menuButtons(state, menuActions);
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
    drawMenu(context, listing([]), buttonsFor(), null);
    expect(texts.map(({ text }) => text)).toContain('You are alone here.');
  });

  test('a finger tip that is put through a button presses it', () => {
    const { done, actions } = recorded();
    const menu = new VrMenu(menuActions);
    menu.setVisible(true);
    menu.show(listing([ben], { done, actions }));
    const sheet = menu.object.children[0];
    const [x, y, w, h] = buttonsFor(ben)[0]?.at ?? [0, 0, 0, 0];
    /** Hands whose rays point away from the sheet. */
    const hand = (side: 'left' | 'right') => {
      const pointer = new MutablePointer('hand', side);
      pointer.setRay(zero, up);
      return pointer;
    };
    const [left, right] = [hand('left'), hand('right')];
    /** Puts a finger tip so far before the middle of the first button [m]. */
    const put = (pointer: MutablePointer, before: number) => {
      menu.object.updateWorldMatrix(true, true);
      const tip = new Vector3((x + w / 2 - menuWidth / 2) / 1000, (menuHeight / 2 - y - h / 2) / 1000, before);
      pointer.setTip(sheet!.localToWorld(tip));
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
