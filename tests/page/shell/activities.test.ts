import { Scene } from 'three';
import { plainAvatar } from 'threepoint/core/body/avatar-ref';
import { defaultCalibration } from 'threepoint/core/body/calibration';
import { allReleased, nothingPressed } from 'threepoint/core/input/button-presses';
import type { Side } from 'threepoint/core/math/side';
import { vec3 } from 'threepoint/core/math/vec3';
import { createPageClock } from 'threepoint/core/tracking/page-clock';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { ServerPresence } from 'threepoint-http/server-presence';
import { createActor } from 'threepoint-page/emulator/actor';
import type { SceneName } from 'threepoint-page/scene/desktop-view';
import type { Surroundings } from 'threepoint-page/scene/surroundings';
import { Activities } from 'threepoint-page/shell/activities';
import { createFrameTiming } from 'threepoint-page/shell/frame-timing';
import { PageGames } from 'threepoint-page/shell/games';
import { PageStudy } from 'threepoint-page/shell/page-study';
import { SessionChanges, type SessionChangesOptions } from 'threepoint-page/shell/session-changes';
import { createSettings, type LastingSettings, SettingsWriter } from 'threepoint-page/shell/settings';
import { createArcheryRunner } from 'threepoint-page/shell/study-archery';
import { readSwitches } from 'threepoint-page/shell/switches';
import { TrackingSource } from 'threepoint-page/shell/tracking-source';
import { Recorder } from 'threepoint-page/studio/recorder';
import type { StudyRun } from 'threepoint-study/participant/study-run';
import type { Notice } from 'threepoint-ui/notices';
import { describe, expect, test, vi } from 'vitest';
import { posed } from '../../games/archery/bowman';
import { drawNowhere } from './drawing-in-node';

drawNowhere();

const ahead = { x: 0, y: 0, z: 0, w: 1 };

/** A wearer whose eyes are this high [m]. */
const wearer = (time: number, eyeHeight: number): TrackingFrame => ({
  time,
  head: { position: vec3(0, eyeHeight, 0), orientation: ahead, tracking: 'tracked' },
  leftHand: null,
  rightHand: null,
});

/** The rest of a page with this address, and what its activities do to it. */
function page() {
  const { switches } = readSwitches('?seed=5&quality=low');
  const settings = createSettings({ ...switches, actor: false }, { preferences: { sound: false } });
  const kept: LastingSettings[] = [];
  const writer = new SettingsWriter(
    settings,
    { remember: (part) => void kept.push(part as LastingSettings) },
    () => undefined,
  );
  const places: (Surroundings | null)[] = [];
  const notices: Notice[] = [];
  const seen = { mirror: null as Side | null, scene: 'studio' as SceneName, orbit: true, mark: true, aims: false };
  const stage = {
    studio: {
      scene: new Scene(),
      setSurroundings: (place: Surroundings | null) => void places.push(place),
      setMarkVisible(visible: boolean) {
        seen.mark = visible;
      },
    },
    view: {
      pose: { position: vec3(0, 1.6, 2), orientation: ahead },
      rayThrough: () => ({ origin: vec3(0, 1.6, 0), direction: vec3(0, 0, -1) }),
      setScene(scene: SceneName) {
        seen.scene = scene;
      },
      setOrbit(on: boolean) {
        seen.orbit = on;
      },
    },
    placeMirror(side: Side | null) {
      seen.mirror = side;
    },
  };
  const mouse = {
    ...{ x: 0, y: 0.1, pressed: false, cancelled: false },
    setEnabled(on: boolean) {
      seen.aims = on;
    },
  };
  const headset = { worn: false, emulator: null, tracking: null };
  const recorder = new Recorder();
  const study = new PageStudy();
  const common = { settings, stage, mouse, headset, body: { calibration: defaultCalibration } };
  const activities = new Activities({
    ...{ ...common, writer, recorder, study, seed: 5 },
    games: new PageGames({
      ...{ ...common, switches, quality: 'low', clock: createPageClock(() => 0), onCaption: () => undefined },
      server: new ServerPresence('http://127.0.0.1:9', () => undefined),
      avatar: { own: true, worn: plainAvatar },
      notices: { show: (level, text) => void notices.push({ level, text }) },
    }),
    notices: { show: (level, text) => void notices.push({ level, text }) },
    wear: () => undefined,
    onCaption: () => undefined,
    onArrival: () => undefined,
    onChange: () => undefined,
  });
  const source = new TrackingSource({
    ...{ settings, headset, recorder, activities, study },
    body: { wearerCalibration: defaultCalibration },
    actor: createActor(),
  });
  const tracked = (time: number) => source.read(time, undefined);
  return { activities, settings, headset, study, seen, places, notices, kept, recorder, tracked };
}

/** The same, on the range. */
async function range() {
  const opened = page();
  await opened.activities.goTo('archery');
  const layout = () => opened.activities.archery?.play.targets;
  return { ...opened, layout };
}

/** A study that this page has joined, in which a participant plays, or waits. */
function joinedStudy({ idle = false } = {}) {
  const run: StudyRun = {
    object: new Scene() as never,
    ...{ idle, measured: true, paused: false },
    frame: () => undefined,
    point: () => undefined,
    sessionChanged: () => undefined,
    probe: () => {
      throw new Error('not asked for here');
    },
  };
  return { run, archery: { played: () => undefined }, ball: { played: () => undefined } };
}

describe('going to a game', () => {
  test('going to archery twice while it loads opens one range', async () => {
    const { activities, places } = page();
    const first = activities.goTo('archery');
    expect(activities.arriving).toBe(true);
    await activities.goTo('archery');
    await first;
    expect(activities.name).toBe('archery');
    expect(activities.arriving).toBe(false);
    expect(places).toHaveLength(1);
  });

  test('what is asked for on the way to the range is not taken up when it is there', async () => {
    const { activities, places } = page();
    await Promise.all([activities.goTo('archery'), activities.goTo('ball')]);
    expect(activities.name).toBe('archery');
    expect(activities.ball).toBeNull();
    expect(places).toHaveLength(1);
  });

  test('camera, mark and mirror go along to the range, and back', async () => {
    const { activities, seen, places } = page();
    await activities.goTo('archery');
    expect(seen).toMatchObject({ scene: 'range', mark: false, mirror: 'left' });
    await activities.goTo('studio');
    expect(seen).toMatchObject({ scene: 'studio', mark: true, mirror: null });
    expect(places.at(-1)).toBeNull();
  });

  test('a court whose bodies cannot be fetched is told in a sentence, and the studio stays', async () => {
    // Nothing is served there.
    vi.stubGlobal('location', { href: 'http://127.0.0.1:9/' });
    const { activities, notices, seen } = page();
    await activities.goTo('ball');
    expect(activities.name).toBe('studio');
    expect(activities.arriving).toBe(false);
    expect(seen).toMatchObject({ scene: 'studio', mark: true });
    expect(notices).toEqual([
      { level: 'error', text: expect.stringMatching(/^The ball court could not be opened: mannequin\.vrm: /) },
    ]);
  });
});

describe('a round', () => {
  const opened = range();

  test('starts anew with a rule that counts hits differently, and goes on with another hand or one hand alone', async () => {
    const { activities, layout } = await opened;
    const begun = layout();
    activities.rule({ bowSide: 'right' });
    activities.rule({ oneHanded: true });
    expect(layout()).toBe(begun);
    activities.rule({ everyHitCounts: true });
    expect(layout()).not.toEqual(begun);
  });

  test('keeps what was chosen for the next visit, and the mirror changes sides with the bow', async () => {
    const { activities, settings, seen, kept } = await opened;
    activities.rule({ bowSide: 'left' });
    expect(settings.bowSide).toBe('left');
    expect(kept.at(-1)).toEqual({ bowSide: 'left' });
    expect(seen.mirror).toBe('left');
    activities.rule({ bowSide: 'right' });
    expect(seen.mirror).toBe('right');
  });

  test('of a seated player has targets as high for the eyes as those of one who stands', async () => {
    const { activities, headset, layout } = await opened;
    const targetsFor = (eyeHeight: number) => {
      activities.play(wearer(eyeHeight, eyeHeight), nothingPressed);
      activities.startRound(8, 70);
      return layout()?.map(({ centre }) => centre.y) ?? [];
    };
    headset.worn = true;
    const seated = targetsFor(1.2);
    const standing = targetsFor(1.6);
    headset.worn = false;
    expect(seated).toHaveLength(4);
    for (const [index, height] of standing.entries()) expect(height - (seated[index] ?? 0)).toBeCloseTo(0.4, 6);
  });

  test('starts anew with every change where the built-in archer shoots: its hands are the rules', async () => {
    const { activities, layout } = await opened;
    activities.chooseShooter('actor');
    const begun = layout();
    activities.rule({ bowSide: 'left' });
    expect(layout()).not.toEqual(begun);
  });

  test('is shot by whom the user chooses, where a recording replays there too', async () => {
    const { activities, recorder, tracked } = await range();
    const ofRecording = wearer(1, 1.9);
    const recording = { device: 'a test', rateHz: 60, calibration: null, frames: [ofRecording, wearer(2, 1.9)] };
    for (const shooter of ['mouse', 'actor'] as const) {
      recorder.take('tall.json', recording);
      recorder.replay();
      expect(tracked(10)?.head).toEqual(ofRecording.head);
      activities.chooseShooter(shooter);
      expect(tracked(10.1)?.head.position.y).toBeLessThan(1.75);
      expect([recorder.mode, recorder.name]).toEqual(['idle', 'tall.json']);
    }
  });

  test('of a player who has left the range and comes back is a new one: its layout is the next', async () => {
    const [left, stayed] = await Promise.all([range(), range()]);
    const first = left.layout();
    expect(first).toEqual(stayed.layout());
    await left.activities.goTo('studio');
    await left.activities.goTo('archery');
    stayed.activities.restartRound();
    expect(left.layout()).not.toEqual(first);
    expect(left.layout()).toEqual(stayed.layout());
  });

  test('is aimed by the mouse where it was chosen; the camera turns with it everywhere else', async () => {
    const { activities, seen } = await opened;
    expect(seen).toMatchObject({ aims: false, orbit: true });
    activities.chooseShooter('mouse');
    expect(seen).toMatchObject({ aims: true, orbit: false });
    await activities.goTo('studio');
    expect(seen).toMatchObject({ aims: false, orbit: true });
  });
});

describe('a player who takes the headset off', () => {
  /** The range of a page whose headset is put on and taken off. */
  async function worn() {
    const opened = await range();
    const { activities, headset, study } = opened;
    const nothing = () => undefined;
    const changes = new SessionChanges({
      headset: { pictureRateHz: 72, visibility: 'none' },
      recorder: new Recorder(),
      timing: createFrameTiming(() => 0),
      view: { view: 'third-person', setView: nothing } as unknown as SessionChangesOptions['view'],
      body: { startSession: nothing, discontinuity: () => activities.jumped() },
      controls: { show: nothing, setWorn: nothing, layOut: nothing },
      ...{ activities, study },
    });
    return {
      ...opened,
      enter() {
        headset.worn = true;
        changes.entered();
      },
      leave() {
        headset.worn = false;
        changes.left();
      },
    };
  }

  test('at full draw shoots no arrow: it is back in the quiver before other hands move the bow', async () => {
    const { activities, enter, leave } = await worn();
    enter();
    const pressed = { left: allReleased, right: { ...allReleased, trigger: 1 } };
    let time = 10;
    const hold = (draw: number, buttons = pressed) => {
      for (let i = 0; i < 9; i++) {
        time += 1 / 90;
        activities.play(posed(time, { draw }), buttons);
      }
    };
    hold(0, nothingPressed);
    hold(0);
    hold(0.5);
    expect(activities.archery?.probe()?.draw).toBeGreaterThan(0.3);
    leave();
    hold(0, nothingPressed);
    expect(activities.archery?.probe()).toMatchObject({ phase: 'ready', arrowsLeft: 5, stage: 'empty' });
  });

  test('aims by the mouse again that was chosen at the desk, also on a range that was opened in the headset', async () => {
    const { activities, seen, enter, leave } = await worn();
    activities.chooseShooter('mouse');
    enter();
    await activities.goTo('studio');
    await activities.goTo('archery');
    leave();
    expect(seen).toMatchObject({ aims: true, orbit: false });
  });
});

describe('a round in a study', () => {
  const opened = range();

  test('is started by the study alone, with its layout, its time and its signal', async () => {
    const { activities, settings, study, layout } = await opened;
    const begun = layout();
    study.join(joinedStudy());
    activities.restartRound();
    activities.rule({ everyHitCounts: true });
    expect(layout()).toBe(begun);
    activities.startRound(42, 30);
    expect(layout()).not.toEqual(begun);
    expect(settings).toMatchObject({ seconds: 30, everyHitCounts: false });
    activities.play(wearer(1, 1.6), nothingPressed);
    expect(activities.archery?.probe()?.phase).toBe('running');
    expect(activities.archery?.probe()?.secondsLeft).toBeCloseTo(30, 1);
  });

  test('tells its trial of every frame', async () => {
    const { activities, study } = await opened;
    const runner = createArcheryRunner({
      goToArchery: async () => undefined,
      startRound: (seed, seconds) => activities.startRound(seed, seconds),
      resetRound: () => activities.resetRound(),
      assists: () => [],
    });
    study.join({ ...joinedStudy(), archery: runner });
    runner.start({ seed: 3, seconds: 1 });
    for (let time = 2; time < 4; time += 1 / 30) activities.play(wearer(time, 1.6), nothingPressed);
    expect(runner.end).toMatchObject({ ended: 'time', score: 0 });
  });

  test('has no built-in archer while its participant does not play', async () => {
    const { activities, study } = await opened;
    study.join(joinedStudy());
    expect(activities.act(5)).not.toBeNull();
    study.join(joinedStudy({ idle: true }));
    expect(activities.act(5.1)).toBeNull();
  });
});
