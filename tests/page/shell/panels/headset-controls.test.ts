import { Group, Raycaster, Vector3 } from 'three';
import { defaultCalibration, GazePointer, MutablePointer, type Pointer, type TrackingFrame } from 'threepoint/core';
import { DeviceCommands } from 'threepoint/internal';
import { fromAxes, identity, type Ray, vec3 } from 'threepoint/math';
import type { CalibrationStep } from 'threepoint-ui';
import { createVrPointers } from 'threepoint-ui/vr';
import { describe, expect, test, vi } from 'vitest';
import type { OpenActivity } from '../../../../src/page/activity/activity';
import type { ActivityContext } from '../../../../src/page/activity/activity-context';
import { menuHeight } from '../../../../src/page/activity/activity-menu';
import { PeopleMenu } from '../../../../src/page/people/menu/people-menu';
import type { ControlledMatch } from '../../../../src/page/people/panel/match-controls';
import type { MatchRound } from '../../../../src/page/people/panel/match-round';
import type { VoicesState } from '../../../../src/page/people/voices/voices-state';
import { activities as registered } from '../../../../src/page/shell/activity-registry';
import type { CalibrationControl } from '../../../../src/page/shell/input/calibration-control';
import type { InputParts } from '../../../../src/page/shell/input/input-parts';
import { HeadsetControls } from '../../../../src/page/shell/panels/headset-controls';
import type { PanelActions } from '../../../../src/page/shell/panels/panel-actions';
import {
  type ComfortActions,
  type ComfortState,
  comfortSheet,
} from '../../../../src/page/shell/panels/vr-menu/comfort-sheet';
import {
  menuButtons,
  noticesTop,
  type VrMenuActions,
  type VrMenuState,
} from '../../../../src/page/shell/panels/vr-menu/menu-buttons';
import type { PageStudy } from '../../../../src/page/shell/session/page-study';
import { createSettings, SettingsWriter, type StoredSettings } from '../../../../src/page/shell/session/settings';
import { readSwitches } from '../../../../src/page/shell/session/switches';
import { Mirrors } from '../../../../src/page/studio/mirrors';
import { allocatedPerFrame } from '../../../allocated-bytes';
import { studyRun } from '../../activity-services';
import { headFrame } from '../../frames';
import { drawNowhere } from '../drawing-in-node';
import { fake } from '../fake';
import { expectApart, studioMenu } from '../menu-parts';

drawNowhere();

/** The back of the left hand towards the eyes, its fingers to the right, as one reads a watch. */
const turnedToFace = fromAxes(
  vec3(0, -Math.SQRT1_2, Math.SQRT1_2),
  vec3(0, Math.SQRT1_2, Math.SQRT1_2),
  vec3(-1, 0, 0),
);

/** A hand that points from before the menu at this point of the world [m], its trigger just pressed. */
function handAt(target: Vector3, pressed = true): MutablePointer {
  const origin = new Vector3(0, 1.4, 0);
  const hand = new MutablePointer('controller', 'right');
  hand.setRay(origin, target.clone().sub(origin).normalize());
  hand.pressed = pressed;
  return hand;
}

/** The controls of a headset in the studio, and what their buttons asked for. */
function headset() {
  const settings = createSettings(readSwitches('').switches, { preferences: {} }, null);
  const writer = new SettingsWriter(settings, { remember: () => undefined }, () => undefined);
  const done: string[] = [];
  const study: PageStudy = { run: null, runners: {} };
  const hands: Pointer[] = [];
  let step: CalibrationStep | null = null;
  const rays = createVrPointers();
  const pointers = { all: hands, offersGaze: false };
  const commands = new DeviceCommands();
  const device = { raised: 0 };
  const parts = fake<InputParts>({
    settings,
    writer,
    study,
    pointers,
    notices: { current: () => [] },
    body: { estimator: 'ik', unavailableEstimators: {}, calibration: { ...defaultCalibration, eyeHeight: 1.6 } },
    headset: {
      passthrough: null,
      passthroughOffered: false,
      commands,
      get raised() {
        return device.raised;
      },
      raise(height: number) {
        device.raised = height;
      },
    },
    userCalibration: { recentre: () => void done.push('recentre') },
    activities: {
      all: registered,
      current: {
        point({ direction }: Ray, press: boolean) {
          done.push(press ? 'a sheet of the game is pressed' : 'a sheet of the game is pointed at');
          // The game's sheet hangs overhead.
          return direction.y > 0.9 ? { distance: 2, owner: 'game', id: 'restart' } : null;
        },
      } as OpenActivity,
      goTo: async (name: string) => void done.push(`go to ${name}`),
      setSound: (on: boolean) => void done.push(`sound ${on}`),
    },
  });
  const measuring = fake<CalibrationControl>({
    get step() {
      return step;
    },
    begin: () => void done.push('calibrate'),
    cancel: () => void done.push('cancel'),
  });
  const actions = fake<PanelActions>({
    chooseEstimator: (name: string) => void done.push(`estimate by ${name}`),
    chooseBuiltInBody: (name: string) => void done.push(`wear ${name}`),
    chooseSkinTone: (tone: string) => void done.push(`in ${tone}`),
    exitVr: () => void done.push('exit'),
  });
  const controls = new HeadsetControls(parts, measuring, actions, rays);
  const [menu] = controls.objects;
  return {
    controls,
    study,
    done,
    hands,
    pointers,
    rays,
    commands,
    device,
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

describe('in the headset', () => {
  test('the menu is there while it is worn, and hands point', () => {
    const { controls, menu, rays } = headset();
    expect([menu.visible, rays.objects.visible]).toEqual([false, false]);
    controls.setWorn(true);
    expect([menu.visible, rays.objects.visible]).toEqual([true, true]);
    controls.setWorn(false);
    expect([menu.visible, rays.objects.visible]).toEqual([false, false]);
  });

  test('the menu hides no part of the mirror from a user who stands on the mark', () => {
    const { menu, onMenu } = headset();
    const [mirror] = new Mirrors('low').object.children;
    mirror!.updateWorldMatrix(true, true);
    const eyes = new Vector3(0, 1.6, 0);
    const covers = (x: number, y: number) => {
      const sight = onMenu(x, y).sub(eyes).normalize();
      return new Raycaster(eyes, sight).intersectObject(mirror!).length > 0;
    };
    for (const y of [0, menuHeight / 2, menuHeight]) expect(covers(0, y)).toBe(false);
    // Ten centimetres further left it would.
    menu.position.x -= 0.1;
    expect(covers(0, menuHeight / 2)).toBe(true);
  });

  test('a sheet of the game takes the press of the hand that presses', () => {
    const { controls, hands, done } = headset();
    controls.setWorn(true);
    const overhead = (pressed: boolean) => handAt(new Vector3(0, 5, 0), pressed);
    const [idle, pressing] = [overhead(false), overhead(true)];
    hands.push(idle, pressing);
    controls.point(null);
    expect(done).toEqual(['a sheet of the game is pressed']);
    expect([idle.pointedAt, pressing.pointedAt?.distance]).toEqual([null, 2]);
  });

  test('a study’s sheet takes the place of the menu: it alone hears the hands', () => {
    const { controls, study, menu, rays, hands, done, onMenu } = headset();
    const pointed: (readonly Pointer[])[] = [];
    study.run = studyRun({ point: (pointers) => void pointed.push(pointers) });
    controls.setWorn(true);
    controls.show();
    expect([menu.visible, rays.objects.visible]).toEqual([false, true]);
    hands.push(handAt(onMenu(320, 162)));
    controls.point(null);
    expect(pointed).toEqual([hands]);
    expect(done).toEqual([]);
  });

  test('a study that is joined in a session takes the menu away', () => {
    const { controls, study, menu } = headset();
    controls.setWorn(true);
    study.run = studyRun();
    controls.show();
    expect(menu.visible).toBe(false);
  });

  test('a trigger pulled at a button does what it says, and the ray ends there', () => {
    const { controls, hands, done, onMenu } = headset();
    controls.setWorn(true);
    controls.show();
    const hand = handAt(onMenu(320, 162));
    hands.push(hand);
    controls.point(null);
    expect(done).toContain('estimate by learned');
    expect(hand.pointedAt?.distance).toBeCloseTo(1.6, 0);
  });

  test('a hand resting on a button has the menu compared once, not in every frame', () => {
    const { controls, hands, onMenu } = headset();
    controls.setWorn(true);
    controls.show();
    hands.push(handAt(onMenu(160, 600), false));
    const compared = vi.spyOn(JSON, 'stringify');
    for (let frame = 0; frame < 100; frame++) controls.point(null);
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
    hands.push(handAt(onMenu(320, 162)));
    controls.point(null);
    expect(done.filter((each) => !each.includes('sheet'))).toEqual([]);
    hands[0] = handAt(onMenu(320, menuHeight - 84));
    controls.point(null);
    expect(done).toContain('cancel');
  });
});

/** A frame of a user who looks ahead; the left hand lies on the belly with its back towards the eyes. */
const wearing = (height = 1.6, leftHand: TrackingFrame['leftHand'] = null): TrackingFrame => ({
  ...headFrame(1, height),
  leftHand,
});

describe('without a controller', () => {
  /** The centre of the button with this label in the world, as drawn now. */
  function press({ controls, hands, onMenu }: ReturnType<typeof headset>, label: string, state: VrMenuState) {
    const button = menuButtons(state, {} as VrMenuActions).find((each) => each.label === label);
    const [x, y, w, h] = button!.at;
    hands.length = 0;
    hands.push(handAt(onMenu(x + w / 2, y + h / 2)));
    controls.point(wearing());
    hands.length = 0;
  }

  test('the menu comes before the eyes at the device’s menu button, within reach, and goes back', () => {
    const page = headset();
    const { controls, commands, menu, hands, done } = page;
    controls.setWorn(true);
    controls.show();
    const sheet = menu.children[0]!;
    const home = sheet.getWorldPosition(new Vector3());
    const call = () => {
      const source = { profiles: ['oculus-hand'], gamepad: { buttons: { 9: { pressed: true } }, axes: [] } };
      commands.watch([source] as unknown as XRInputSourceArray);
      controls.point(wearing());
      commands.watch([] as unknown as XRInputSourceArray);
    };
    call();
    const at = sheet.getWorldPosition(new Vector3());
    expect(at.distanceTo(new Vector3(0, 1.6, 0))).toBeLessThan(0.6);
    // A finger tip reaches and presses it there.
    menu.updateWorldMatrix(true, true);
    const poke = new MutablePointer('hand', 'left');
    poke.setRay(vec3(0, 1, 0), vec3(0, 1, 0));
    hands.push(poke);
    for (const before of [0.1, 0.05, -0.01]) {
      poke.setTip(sheet.localToWorld(new Vector3(0, (menuHeight / 2 - 162) / 1000, before / 0.5)));
      controls.point(wearing());
    }
    expect(done).toContain('estimate by learned');
    call();
    expect(sheet.getWorldPosition(new Vector3()).distanceTo(home)).toBeLessThan(1e-6);
  });

  test('the back of a wrist before the eyes has a menu button for the other hand', () => {
    const { controls, menu, hands } = headset();
    controls.setWorn(true);
    controls.show();
    const wrist = { position: vec3(0, 1.5, -0.4), orientation: turnedToFace, tracking: 'tracked' as const };
    controls.point(wearing(1.6, wrist));
    const [button] = controls.objects[2].children;
    expect(button?.visible).toBe(true);
    const poke = (side: 'left' | 'right') => {
      const finger = new MutablePointer('hand', side);
      finger.setRay(vec3(0, 1, 0), vec3(0, 1, 0));
      hands.splice(0, hands.length, finger);
      for (const before of [0.1, 0.03, -0.01]) {
        button!.updateWorldMatrix(true, false);
        finger.setTip(button!.localToWorld(new Vector3(0, 0, before)));
        controls.point(wearing(1.6, wrist));
      }
    };
    const distance = () => menu.children[0]!.getWorldPosition(new Vector3()).distanceTo(new Vector3(0, 1.6, 0));
    poke('left');
    expect(distance(), 'a hand does not touch its own wrist').toBeGreaterThan(1);
    poke('right');
    expect(distance()).toBeLessThan(0.6);
    const elsewhere = {
      palm: { orientation: identity, position: vec3(0, 1.7, -0.4) },
      hip: { position: vec3(-0.3, 1, -0.1) },
    };
    for (const place of [elsewhere.palm, elsewhere.hip]) {
      controls.point(wearing(1.6, { ...wrist, ...place }));
      expect(button?.visible).toBe(false);
    }
  });

  test('the gaze is offered to a user without hands, and acts on the menu once accepted', () => {
    const { controls, settings, hands, pointers, done, onMenu, menu } = headset();
    controls.setWorn(true);
    controls.show();
    const gaze = new GazePointer();
    let time = 0;
    const look = (target: Vector3, seconds: number) => {
      for (let frame = 0; frame < 72 * seconds; frame++) {
        time += 1 / 72;
        const head = new Group();
        head.position.set(0, 1.6, 0);
        // An object looks along +Z, a head along −Z.
        head.lookAt(head.position.clone().multiplyScalar(2).sub(target));
        const { x, y, z, w } = head.quaternion;
        const pose = { position: vec3(0, 1.6, 0), orientation: { x, y, z, w } };
        gaze.follow(time, pose);
        controls.point({ ...wearing(), head: { ...pose, tracking: 'tracked' } });
      }
    };
    hands.push(gaze);
    pointers.offersGaze = true;
    const exit = () => onMenu(160, 600);
    look(exit(), 2);
    expect(done.filter((each) => !each.includes('sheet'))).toEqual([]);
    const offer = controls.objects[3];
    expect(offer.visible).toBe(true);
    look(offer.position.clone(), 2);
    expect(settings.gaze).toBe(true);
    pointers.offersGaze = false;
    look(exit(), 2);
    expect(offer.visible).toBe(false);
    expect(done).toContain('calibrate');
    expect(menu.visible).toBe(true);
  });

  test('the comfort sheet turns, raises, seats and lets the gaze choose', () => {
    const page = headset();
    const { controls, commands, device, settings, done } = page;
    controls.setWorn(true);
    controls.show();
    press(page, 'Comfort', { ...studioMenu, places: [] });
    const sheet = (change: Partial<ComfortState> = {}): VrMenuState => ({
      ...studioMenu,
      sheet: comfortSheet(
        { moves: true, raised: 0, seated: false, gaze: false, sound: true, largerText: false, ...change },
        {} as ComfortActions,
      ),
    });
    const turns = ['Turn left', 'Turn right'].map((label) => {
      press(page, label, sheet());
      return commands.takeTurn();
    });
    expect(turns).toEqual([1, -1]);
    press(page, 'Raise me', sheet());
    press(page, 'Raise me', sheet());
    expect(device.raised).toBeCloseTo(0.1);
    press(page, 'Lower me', sheet());
    expect(device.raised).toBeCloseTo(0.05);
    // Seated: the eyes, 1.15 m high as tracked, are shown at the calibrated 1.6 m.
    controls.point(wearing(1.2));
    const pressSeated = (label: string, seated: boolean) => {
      const button = menuButtons(sheet({ seated }), {} as VrMenuActions).find((each) => each.label === label)!;
      const [x, y, w, h] = button.at;
      page.hands.push(handAt(page.onMenu(x + w / 2, y + h / 2)));
      controls.point(wearing(1.15 + device.raised));
      page.hands.length = 0;
    };
    pressSeated('I sit', false);
    expect(device.raised).toBeCloseTo(0.45);
    expect(done).toContain('recentre');
    pressSeated('I stand', true);
    expect(device.raised).toBe(0);
    press(page, 'Gaze: off', sheet());
    expect(settings.gaze).toBe(true);
  });
});

describe('the buttons of the menu', () => {
  const mirror: VrMenuState = { ...studioMenu, places: registered };
  const ben: MatchRound['people'][number] = {
    ...{ seat: 1, name: 'Ben', station: 1, label: '2 · Ben', role: 'Right thrower', free: false },
    ...{ voice: 'muted', link: 'none', silenced: false, hidden: false },
  };
  const done: string[] = [];
  const actions: VrMenuActions = {
    chooseEstimator: (name) => void done.push(name),
    calibrate: () => undefined,
    cancelCalibration: () => undefined,
    recentre: () => undefined,
    openComfort: () => void done.push('comfort'),
    openGrip: () => void done.push('grip'),
    setOverlay: (on) => void done.push(`overlay ${on}`),
    setPassthrough: (on) => void done.push(`next in the room ${on}`),
    setBeside: (on) => void done.push(`beside ${on}`),
    goTo: (place) => void done.push(`go to ${place}`),
    chooseBuiltInBody: (name) => void done.push(`wear ${name}`),
    chooseSkinTone: (tone) => void done.push(`in ${tone}`),
    exit: () => undefined,
  };
  interface AtCourt {
    readonly round?: Partial<MatchRound>;
    readonly voices?: Partial<VoicesState>;
    readonly plainOthers?: boolean;
    readonly room?: string;
  }
  /** The menu at the court, during a match that the user plays alone unless these say otherwise. */
  function atCourt({ round, voices, plainOthers = false, room }: AtCourt = {}): VrMenuState {
    const running = { seat: 0, phase: 'running', ready: false, joined: true, ended: null, people: [] };
    const match = fake<ControlledMatch>({
      round: () => ({ ...running, ...round }) as MatchRound,
      banner: () => null,
      play: { connection: { setReady: (on: boolean) => done.push(`ready ${on}`) } },
      voices: { state: { phase: 'none', muted: true, microphoneMissing: false, message: null, ...voices } },
    });
    const context = fake<ActivityContext>({
      settings: { plainOthers },
      writer: { keep: (kept: StoredSettings) => done.push(`plain others ${kept.plainOthers}`) },
      switches: { room: room ?? null },
      server: { state: 'here' },
    });
    return { ...mirror, activity: new PeopleMenu(match, context).state() };
  }
  const between = (ready: boolean) => ({ phase: 'ready', ready }) as const;
  const labels = (state: VrMenuState) => menuButtons(state, actions).map(({ label }) => label);

  test.each([
    ['', false],
    [', where the device was asked for its body', true],
  ])('lie apart and inside the menu at the mirror and at the court%s', (_, deviceBody) => {
    const voices = (phase: VoicesState['phase']) =>
      atCourt({ round: { ...between(true), people: [ben] }, room: 'ours', voices: { phase } });
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
    expect(labels(atCourt({ round: between(false) }))).toContain('Ready');
    expect(labels(atCourt({ round: between(true) }))).toContain('Wait for me');
    expect(labels(atCourt())).not.toContain('Ready');
    expect(labels(atCourt({ room: 'ours' }))).toContain('Invite');
    expect(labels(atCourt())).not.toContain('Invite');
    expect(labels(atCourt({ round: { people: [ben] } }))).toContain('Players');
    expect(labels(atCourt())).not.toContain('Players');
    const talking = (phase: VoicesState['phase'], muted = true, microphoneMissing = false) =>
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

  test('each switch asks for the other state', () => {
    const press = (id: string, state: VrMenuState) =>
      menuButtons(state, actions)
        .find((each) => each.id === id)
        ?.act();
    press('overlay', { ...mirror, overlay: true });
    press('ball', mirror);
    press('ready', atCourt({ round: between(true) }));
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
    expect(looks.slice(0, 5)).toEqual(['off', 'chosen', 'plain', 'plain', 'plain']);
  });

  test('the method as published is offered among the others', () => {
    const offered = menuButtons(mirror, actions).flatMap(({ id }) => (id.startsWith('paper') ? [id] : []));
    expect(offered).toEqual(['paper', 'paper-published']);
  });

  // Measured: 600 to 750 bytes of numbers and emptied lists; 2,580 with a list and hits for each panel.
  test('a frame with gaze offer, wrist button and menu allocates no objects for each pointer', () => {
    const { controls, hands, pointers } = headset();
    controls.setWorn(true);
    const gaze = new GazePointer();
    const hand = handAt(new Vector3(0, 1.3, -1.2), false);
    hands.push(hand, gaze);
    pointers.offersGaze = true;
    const frame: TrackingFrame = {
      ...headFrame(0, 1.6),
      leftHand: { position: vec3(-0.05, 1.45, -0.35), orientation: turnedToFace, tracking: 'tracked' },
      rightHand: null,
    };
    let time = 0;
    const show = () => {
      time += 1 / 72;
      hand.begin();
      gaze.follow(time, frame.head);
      controls.point(frame);
    };
    show();
    const [, , wrists, offer] = controls.objects;
    expect([wrists.children[0]?.visible, offer.visible]).toEqual([true, true]);
    expect(allocatedPerFrame(show)).toBeLessThan(1300);
  });
});
