import { Group, Vector3 } from 'three';
import type { Ray } from 'threepoint/core/math/ray';
import type { OpenActivity } from 'threepoint-page/activity/activity';
import { menuHeight } from 'threepoint-page/activity/activity-menu';
import { type BallMenuActions, type BallMenuState, ballEntries } from 'threepoint-page/ball/ball-menu';
import type { OtherPlayer } from 'threepoint-page/ball/other-players';
import { activities as registered } from 'threepoint-page/shell/activity-registry';
import { HeadsetControls } from 'threepoint-page/shell/controls/headset-controls';
import { PageStudy } from 'threepoint-page/shell/page-study';
import { createSettings, SettingsWriter } from 'threepoint-page/shell/settings';
import { readSwitches } from 'threepoint-page/shell/switches';
import {
  menuButtons,
  noticesTop,
  type VrMenuActions,
  type VrMenuState,
} from 'threepoint-page/shell/vr-menu/menu-buttons';
import type { CalibrationStep } from 'threepoint-ui/calibration-dialog';
import type { Pointer } from 'threepoint-ui/vr-pointers';
import { afterAll, describe, expect, test, vi } from 'vitest';
import { drawNowhere } from './drawing-in-node';
import { expectApart, studioMenu } from './menu-parts';

drawNowhere();
afterAll(() => vi.unstubAllGlobals());

/** A hand that points from before the menu at this point of the world [m], its trigger just pressed. */
function handAt(target: Vector3) {
  const origin = new Vector3(0, 1.4, 0);
  const shown: (number | null)[] = [];
  const hand: Pointer = {
    origin,
    direction: target.clone().sub(origin).normalize(),
    tip: null,
    pressed: true,
    showRay: (distance) => void shown.push(distance),
  };
  return { hand, shown };
}

/** The controls of a headset in the studio, and what their buttons asked for. */
function headset() {
  const settings = createSettings(readSwitches('').switches, { preferences: {} });
  const writer = new SettingsWriter(settings, { remember: () => undefined }, () => undefined);
  const done: string[] = [];
  const study = new PageStudy();
  const hands: Pointer[] = [];
  let step: CalibrationStep | null = null;
  const pointers = { objects: new Group(), take: () => hands };
  const controls = new HeadsetControls({
    settings,
    writer,
    study,
    pointers,
    notices: { show: () => undefined, current: () => [] },
    body: { estimator: 'ik', unavailable: {} },
    headset: { passthrough: null, passthroughOffered: false },
    activities: {
      all: registered,
      current: {
        point({ direction }: Ray, press: boolean) {
          done.push(press ? 'a sheet of the game is pressed' : 'a sheet of the game is pointed at');
          // The game's sheet hangs overhead.
          return direction.y > 0.9 ? 2 : null;
        },
      } as OpenActivity,
      goTo: async (name) => void done.push(`go to ${name}`),
    },
    measuring: {
      get step() {
        return step;
      },
      begin: () => void done.push('calibrate'),
      cancel: () => void done.push('cancel'),
    },
    actions: {
      chooseEstimator: (name) => void done.push(`estimate by ${name}`),
      chooseBuiltInBody: (name) => void done.push(`wear ${name}`),
      chooseSkinTone: (tone) => void done.push(`in ${tone}`),
      recentre: () => void done.push('recentre'),
      exitVr: () => void done.push('exit'),
    },
  });
  const [menu] = controls.objects;
  return {
    controls,
    study,
    done,
    hands,
    pointers,
    menu,
    settings,
    measure(next: CalibrationStep | null) {
      step = next;
      controls.show();
    },
    /** Returns the place in the world of this canvas point of the menu's sheet (640 wide). */
    onMenu(x: number, y: number) {
      menu.updateWorldMatrix(true, true);
      const sheet = menu.children[0];
      if (!sheet) throw new Error('the menu has no sheet');
      return sheet.localToWorld(new Vector3((x - 320) / 1000, (menuHeight / 2 - y) / 1000, 0));
    },
  };
}

/** A study whose sheet writes down the hands that point at it. */
function studyOf(pointed: (readonly Pointer[])[]) {
  const run = {
    object: new Group() as never,
    idle: true,
    paused: false,
    frame: () => undefined,
    point: (pointers: readonly Pointer[]) => void pointed.push(pointers),
    sessionChanged: () => undefined,
    probe: () => {
      throw new Error('not asked for here');
    },
  };
  return { run, runners: {} };
}

describe('in the headset', () => {
  test('the menu is there while it is worn, and hands point', () => {
    const { controls, menu, pointers } = headset();
    expect([menu.visible, pointers.objects.visible]).toEqual([false, false]);
    controls.setWorn(true);
    expect([menu.visible, pointers.objects.visible]).toEqual([true, true]);
    controls.setWorn(false);
    expect([menu.visible, pointers.objects.visible]).toEqual([false, false]);
  });

  test('of two hands at a sheet of the game the one that presses is heard', () => {
    const { controls, hands, done } = headset();
    controls.setWorn(true);
    const overhead = () => handAt(new Vector3(0, 5, 0));
    const [idle, pressing] = [overhead(), overhead()];
    hands.push({ ...idle.hand, pressed: false }, pressing.hand);
    controls.point();
    expect(done).toEqual(['a sheet of the game is pressed']);
    expect([idle.shown.at(-1), pressing.shown.at(-1)]).toEqual([null, 2]);
  });

  test('a study’s sheet takes the place of the menu: it alone hears the hands', () => {
    const { controls, study, menu, pointers, hands, done, onMenu } = headset();
    const pointed: (readonly Pointer[])[] = [];
    study.join(studyOf(pointed));
    controls.setWorn(true);
    controls.show();
    expect([menu.visible, pointers.objects.visible]).toEqual([false, true]);
    hands.push(handAt(onMenu(320, 162)).hand);
    controls.point();
    expect(pointed).toEqual([hands]);
    expect(done).toEqual([]);
  });

  test('a study that is joined in a session takes the menu away', () => {
    const { controls, study, menu } = headset();
    controls.setWorn(true);
    study.join(studyOf([]));
    controls.show();
    expect(menu.visible).toBe(false);
  });

  test('a trigger pulled at a button does what it says, and the ray ends there', () => {
    const { controls, hands, done, onMenu } = headset();
    controls.setWorn(true);
    controls.show();
    const { hand, shown } = handAt(onMenu(320, 162));
    hands.push(hand);
    controls.point();
    expect(done).toContain('estimate by learned');
    expect(shown.at(-1)).toBeCloseTo(1.6, 0);
  });

  test('a hand that rests on a button has the menu compared with what it shows once, not in every frame', () => {
    const { controls, hands, onMenu } = headset();
    controls.setWorn(true);
    controls.show();
    const { hand } = handAt(onMenu(160, 600));
    hands.push({ ...hand, pressed: false });
    const compared = vi.spyOn(JSON, 'stringify');
    for (let frame = 0; frame < 100; frame++) controls.point();
    expect(compared).toHaveBeenCalledTimes(1);
    compared.mockRestore();
  });

  test('larger text makes a larger menu', () => {
    const { controls, settings, menu } = headset();
    const writer = new SettingsWriter(settings, { remember: () => undefined }, () => controls.show());
    writer.keep({ largerText: true });
    expect(menu.scale.x).toBe(1.3);
  });

  test('while the wearer is measured nothing but Cancel can be pressed', () => {
    const { controls, hands, done, onMenu, measure } = headset();
    controls.setWorn(true);
    measure({ kind: 'countdown', secondsLeft: 3 });
    hands.push(handAt(onMenu(320, 162)).hand);
    controls.point();
    expect(done.filter((each) => !each.includes('sheet'))).toEqual([]);
    hands[0] = handAt(onMenu(320, menuHeight - 84)).hand;
    controls.point();
    expect(done).toContain('cancel');
  });
});

describe('the buttons of the menu', () => {
  const mirror: VrMenuState = { ...studioMenu, places: registered };
  const match: BallMenuState = {
    ready: null,
    plainOthers: false,
    others: [],
    canInvite: false,
    voices: { phase: 'none', muted: true, microphoneMissing: false },
  };
  const ben: OtherPlayer = {
    seat: 1,
    name: 'Ben',
    role: 'Right thrower',
    status: 'muted',
    silenced: false,
    hidden: false,
    muting: 'offered',
  };
  const done: string[] = [];
  const actions: VrMenuActions = {
    chooseEstimator: (name) => void done.push(name),
    calibrate: () => undefined,
    cancelCalibration: () => undefined,
    recentre: () => undefined,
    setOverlay: (on) => void done.push(`overlay ${on}`),
    setPassthrough: (on) => void done.push(`next in the room ${on}`),
    setBeside: (on) => void done.push(`beside ${on}`),
    goTo: (place) => void done.push(`go to ${place}`),
    chooseBuiltInBody: (name) => void done.push(`wear ${name}`),
    chooseSkinTone: (tone) => void done.push(`in ${tone}`),
    exit: () => undefined,
  };
  const ballActions: BallMenuActions = {
    setPlainOthers: (on) => void done.push(`plain others ${on}`),
    ready: (on) => void done.push(`ready ${on}`),
    askVoices: (on) => void done.push(`ask ${on}`),
    joinVoices: () => void done.push('join voices'),
    mute: (on) => void done.push(`mute ${on}`),
    listOthers: () => void done.push('list others'),
    invite: () => void done.push('invite'),
  };
  /** The menu at the court. */
  const atCourt = (change: Partial<BallMenuState> = {}): VrMenuState => ({
    ...mirror,
    activity: { entries: ballEntries({ ...match, ...change }, ballActions), sheet: null },
  });
  const labels = (state: VrMenuState) => menuButtons(state, actions).map(({ label }) => label);

  test.each([
    ['', false],
    [', where the device was asked for its body', true],
  ])('lie apart and inside the menu at the mirror and at the court%s', (_, deviceBody) => {
    const voices = (phase: BallMenuState['voices']['phase']) =>
      atCourt({
        ready: true,
        others: [ben],
        canInvite: true,
        voices: { phase, muted: true, microphoneMissing: false },
      });
    for (const state of [mirror, voices('in'), voices('asked'), voices('off')]) {
      const buttons = menuButtons({ ...state, deviceBody, builtInBody: 'woman' }, actions);
      expect(buttons.some(({ id }) => id === 'device')).toBe(deviceBody);
      expect(buttons.length).toBeGreaterThan(8);
      for (const { at } of buttons) {
        const [x, y, w, h] = at;
        expect(Math.min(x, y, 640 - x - w, noticesTop - y - h)).toBeGreaterThanOrEqual(0);
      }
      expectApart(buttons);
    }
  });

  test('offer what can be done here', () => {
    expect(labels(mirror)).toEqual(expect.arrayContaining(['Archery', 'Ball game', 'Body: Mannequin']));
    expect(labels({ ...mirror, builtInBody: 'child' })).toEqual(expect.arrayContaining(['Body: Child', 'Skin: own']));
    expect(labels(mirror).join()).not.toContain('Skin');
    expect(labels(atCourt())).toContain('To the mirror');
    expect(labels(atCourt({ ready: false }))).toContain('Ready');
    expect(labels(atCourt({ ready: true }))).toContain('Wait for me');
    expect(labels(atCourt())).not.toContain('Ready');
    expect(labels(atCourt({ canInvite: true }))).toContain('Invite');
    expect(labels(atCourt())).not.toContain('Invite');
    expect(labels(atCourt({ others: [ben] }))).toContain('Players');
    expect(labels(atCourt())).not.toContain('Players');
    const talking = (phase: BallMenuState['voices']['phase'], muted = true, microphoneMissing = false) =>
      labels(atCourt({ voices: { phase, muted, microphoneMissing } }));
    expect(talking('none').join()).not.toMatch(/Talk|ute me/);
    expect(talking('off')).toContain('Talk');
    expect(talking('asked')).toEqual(expect.arrayContaining(['Join, muted', 'Not now']));
    expect(talking('in')).toContain('Unmute me');
    expect(talking('in', false)).toContain('Mute me');
    expect(talking('in', true, true)).toContain('No microphone');
  });

  test.each([
    [false, 'Exit VR'],
    [true, 'Exit AR'],
  ])('name the session that ends (in passthrough: %s)', (inPassthrough, label) => {
    const exit = menuButtons({ ...mirror, inPassthrough }, actions).find(({ id }) => id === 'exit');
    expect(exit?.label).toBe(label);
  });

  test('that change something ask for the other state', () => {
    const press = (id: string, state: VrMenuState) =>
      menuButtons(state, actions)
        .find((each) => each.id === id)
        ?.act();
    press('overlay', { ...mirror, overlay: true });
    press('ball', mirror);
    press('ready', atCourt({ ready: true }));
    press('body', { ...mirror, builtInBody: 'child' });
    press('skin', { ...mirror, builtInBody: 'child' });
    press('skin', { ...mirror, builtInBody: 'child', skinTone: 'dark' });
    press('others', atCourt({ plainOthers: true }));
    press('passthrough', { ...mirror, nextPassthrough: false });
    press('beside', { ...mirror, beside: true });
    press('passthrough', mirror);
    press('studio', atCourt());
    const bodies = ['wear mannequin', 'in fair', 'in fair', 'plain others false'];
    expect(done).toEqual([
      'overlay false',
      'go to ball',
      'ready false',
      ...bodies,
      'next in the room true',
      'beside false',
      'go to studio',
    ]);
  });

  test('an unavailable estimator is shown and cannot be pressed', () => {
    const looks = menuButtons({ ...mirror, unavailable: { learned: 'no network' } }, actions).map(({ look }) => look);
    expect(looks.slice(0, 4)).toEqual(['off', 'chosen', 'plain', 'plain']);
  });
});
