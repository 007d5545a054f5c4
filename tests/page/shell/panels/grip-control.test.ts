import { Body } from 'threepoint';
import { largestGripOffset } from 'threepoint/core';
import { expect, test } from 'vitest';
import { menuHeight, menuMargin, menuWidth } from '../../../../src/page/activity/activity-menu';
import { GripControl } from '../../../../src/page/shell/panels/grip-control';
import { gripSheet } from '../../../../src/page/shell/panels/vr-menu/grip-sheet';
import { menuButtons, type VrMenuActions } from '../../../../src/page/shell/panels/vr-menu/menu-buttons';
import { createPreferenceStore, type Preferences } from '../../../../src/page/shell/session/preferences';
import type { StageParts } from '../../../../src/page/shell/stage/stage-parts';
import { fake } from '../fake';
import { expectApart, paper, studioMenu } from '../menu-parts';
import { memoryStorage } from '../session/memory-storage';

type Held = Preferences['gripDevices'] | null;

const quest = { left: 'meta-quest-touch-plus', right: 'meta-quest-touch-plus' } as const;

/** The control of a user who holds these controllers; null: they wear no headset. */
function user(held: Held, storage = memoryStorage()) {
  const body = new Body({ estimator: 'ik' });
  const store = createPreferenceStore(storage);
  body.setGripOffsets(store.preferences.gripOffsets ?? {});
  const headset = { heldDevices: held };
  const parts = { body, store, headset, onChange: () => undefined } as Pick<StageParts, 'body' | 'store' | 'onChange'>;
  const grip = new GripControl(fake<StageParts>(parts));
  return {
    body,
    store,
    headset,
    grip,
    /** Presses the buttons of the sheet in the headset's menu with these ids, one after the other. */
    press(...ids: readonly string[]) {
      for (const id of ids) {
        const { buttons } = gripSheet(grip.state!, grip, () => undefined);
        buttons.find((button) => button.id === id && button.look !== 'off')?.act();
      }
    },
    /** The values that the sheet shows, from top to bottom. */
    get values() {
      return grip.state?.rows.map(({ value }) => value);
    },
  };
}

test('steps in the headset’s menu move both hands, or one, and are stored with the device', () => {
  const storage = memoryStorage();
  const { press, body, store, grip } = user(quest, storage);
  press('ahead on', 'ahead on', 'roll back');
  const { left, right } = body.userCalibration.gripOffsets!['meta-quest-touch-plus']!;
  expect(left).toEqual(right);
  // A hand that moves forward has the grip nearer to its wrist.
  expect(left!.ahead).toBeCloseTo(-0.01, 9);
  expect(left!.roll).toBeCloseTo((-3 * Math.PI) / 180, 9);
  press('right', 'below back');
  const offsets = body.userCalibration.gripOffsets!['meta-quest-touch-plus']!;
  expect(offsets.left).toEqual(left);
  expect(offsets.right!.below).toBeCloseTo(-0.005, 9);
  press('both');
  expect(user(quest, storage).values).toEqual(['+10 mm', '0 / −5 mm', '0 mm', '0°', '0°', '−3°']);
  expect(grip.state!.device).toBe('Meta Quest Touch Plus');
  expect(createPreferenceStore(storage).preferences).toEqual(store.preferences);
  press('left', 'reset grip');
  expect(body.userCalibration.gripOffsets!['meta-quest-touch-plus']).toEqual({ right: offsets.right });
});

test('each hand corrects the device that it holds', () => {
  const { press, body, grip, headset } = user({ left: 'meta-quest-touch-plus', right: 'logitech-mx-ink' });
  expect(grip.state!.device).toBe('Meta Quest Touch Plus, Logitech MX Ink');
  press('right', 'pitch on');
  expect(Object.keys(body.userCalibration.gripOffsets!)).toEqual(['logitech-mx-ink']);
  headset.heldDevices = { left: 'meta-quest-touch-plus' };
  expect(grip.state, 'the right hand holds none').toMatchObject({ hands: 'both', device: 'Meta Quest Touch Plus' });
  headset.heldDevices = {};
  expect(grip.state).toBeNull();
});

test('a step ends at the largest correction, which no body refuses', () => {
  const { press, body, grip } = user(quest);
  press(...Array.from({ length: 30 }, () => 'thumbward back'));
  const { thumbward } = body.userCalibration.gripOffsets!['meta-quest-touch-plus']!.left!;
  expect(thumbward).toBeCloseTo(largestGripOffset.thumbward, 9);
  const shown = gripSheet(grip.state!, grip, () => undefined).buttons.filter(({ look }) => look === 'off');
  expect(shown.map(({ id }) => id)).toEqual(['thumbward back']);
});

test('after a session the panel corrects the controllers that were held last', () => {
  const { grip, store } = user(null);
  expect(grip.state).toBeNull();
  store.remember({ gripDevices: { left: 'valve-index' } });
  expect(grip.state!.device).toBe('Valve Index');
  expect(user({}).grip.state, 'bare hands').toBeNull();
});

test('a user with controllers finds it in the menu; its buttons lie apart', () => {
  const labels = (holdsControllers: boolean) =>
    menuButtons({ ...studioMenu, holdsControllers }, {} as VrMenuActions).map(({ label }) => label);
  expect([labels(true).includes('My grip'), labels(false).includes('My grip')]).toEqual([true, false]);
  const { grip } = user(quest);
  const sheet = gripSheet(grip.state!, grip, () => undefined);
  expect(sheet.buttons).toHaveLength(17);
  expectApart(sheet.buttons);
  for (const { at } of sheet.buttons) {
    const [x, y, width, height] = at;
    expect(Math.min(x, menuWidth - x - width, menuHeight - y - height)).toBeGreaterThanOrEqual(menuMargin - 1e-6);
  }
  const { context, texts } = paper();
  sheet.draw(context);
  for (const { text, y } of texts.filter(({ text }) => /mm|°/.test(text))) {
    const row = sheet.buttons.filter(({ at }) => y > at[1] && y < at[1] + at[3]);
    expect(row, text).toHaveLength(2);
  }
});
