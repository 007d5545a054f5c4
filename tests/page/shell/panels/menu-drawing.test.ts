import { qrCode } from 'threepoint-ui';
import { encode } from 'uqr';
import { describe, expect, test } from 'vitest';
import { menuHeight, menuMargin, menuWidth } from '../../../../src/page/activity/activity-menu';
import { invitationSheet, type ShownInvitation } from '../../../../src/page/people/menu/invitation-sheet';
import {
  menuButtons,
  type VrMenuActions,
  type VrMenuState,
} from '../../../../src/page/shell/panels/vr-menu/menu-buttons';
import { drawMenu } from '../../../../src/page/shell/panels/vr-menu/menu-drawing';
import { paper, studioMenu } from '../menu-parts';

const address = 'https://play.example.org/?play=ball&room=meadow';

const actions = {} as VrMenuActions;

function drawn(change: Partial<ShownInvitation>) {
  const invitation: ShownInvitation = { room: 'meadow', address, limit: null, code: 'loading', ...change };
  const state: VrMenuState = {
    ...studioMenu,
    sheet: invitationSheet(invitation, () => undefined),
    notice: 'Waiting for you.',
  };
  const { context, texts, boxes } = paper();
  const buttons = menuButtons(state, actions);
  drawMenu(context, state, buttons, null);
  return { texts, boxes, buttons };
}

describe('the invitation in the headset', () => {
  test('is the address’s code, module for module, on white wide enough for cameras', async () => {
    const { boxes } = drawn({ code: await qrCode(address) });
    const [ground, ...modules] = boxes;
    expect(ground).toEqual({
      fill: '#fff',
      at: [menuMargin, 116, menuWidth - 2 * menuMargin, menuWidth - 2 * menuMargin],
    });
    const { data, size } = encode(address, { ecc: 'M', border: 0 });
    const side = modules[0]?.at[2] ?? 0;
    const left = Math.min(...modules.map(({ at: [x = 0] }) => x));
    const top = Math.min(...modules.map(({ at: [, y = 0] }) => y));
    const read = data.map((row) => row.map(() => false));
    for (const { at, fill } of modules) {
      const [x = 0, y = 0] = at;
      expect([fill, at[2], at[3]]).toEqual(['#000', side, side]);
      (read[(y - top) / side] as boolean[])[(x - left) / side] = true;
    }
    expect(read).toEqual(data);
    expect(left - menuMargin).toBeGreaterThanOrEqual(4 * side);
    expect(menuWidth - menuMargin - left - size * side).toBeGreaterThanOrEqual(4 * side);
    // The sheet is 64 cm wide: a module of a centimetre can be distinguished on a cast of the headset's picture.
    expect(side).toBeGreaterThanOrEqual(10);
  });

  test('has the room and its address in large letters, and one button', () => {
    const { texts, buttons } = drawn({ limit: 'This address works on this computer only.' });
    const large = texts.filter(({ size }) => size >= 34).map(({ text }) => text);
    expect(large).toEqual(
      expect.arrayContaining(['Room meadow', 'https://play.example.org/', '?play=ball&room=meadow']),
    );
    expect(texts.map(({ text }) => text)).toContain('This address works on this computer only.');
    expect(texts.map(({ text }) => text)).not.toContain('Waiting for you.');
    expect(buttons.map(({ label }) => label)).toEqual(['Close']);
    expect(Math.max(...texts.filter(({ text }) => text !== 'Close').map(({ y }) => y))).toBeLessThan(menuHeight - 140);
  });

  test('says that the code is loading, or that it could not be loaded', () => {
    expect(drawn({ code: 'loading' }).texts.map(({ text }) => text)).toContain('The code is loading.');
    const failed = drawn({ code: 'failed' });
    expect(failed.texts.map(({ text }) => text).join(' ')).toContain('The code could not be loaded. Use the address.');
    expect(failed.boxes).toEqual([]);
  });
});
