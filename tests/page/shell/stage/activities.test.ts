import { allReleased, nothingPressed, unknownFingers } from 'threepoint/core';
import { type Side, vec3 } from 'threepoint/math';
import { gameNames } from 'threepoint-games/all';
import { describe, expect, test, vi } from 'vitest';
import type { Activity } from '../../../../src/page/activity/activity';
import { type ArcheryActivity, rangeScene } from '../../../../src/page/archery/archery-activity';
import { createArcheryRunner } from '../../../../src/page/archery/archery-runner';
import { createActor } from '../../../../src/page/emulator/actor';
import { type CameraScene, studioScene } from '../../../../src/page/scene/desktop-view';
import { activities as registered } from '../../../../src/page/shell/activity-registry';
import type { CalibrationControl } from '../../../../src/page/shell/input/calibration-control';
import type { InputParts } from '../../../../src/page/shell/input/input-parts';
import { TrackingSource } from '../../../../src/page/shell/input/tracking-source';
import type { Controls } from '../../../../src/page/shell/panels/controls';
import { menuStateOf } from '../../../../src/page/shell/panels/headset-controls';
import { menuButtons, type VrMenuActions } from '../../../../src/page/shell/panels/vr-menu/menu-buttons';
import { FrameTiming } from '../../../../src/page/shell/session/frame-timing';
import { SessionChanges } from '../../../../src/page/shell/session-changes';
import { Activities, type ActivitiesOptions } from '../../../../src/page/shell/stage/activities';
import { createRunners } from '../../../../src/page/shell/stage/join-study';
import type { PassthroughHost } from '../../../../src/page/shell/stage/passthrough-host';
import type { StageParts } from '../../../../src/page/shell/stage/stage-parts';
import { Recorder } from '../../../../src/page/studio/recorder';
import { posed } from '../../../games/archery/bowman';
import { activityServices, noPointers, noSession, studyRun } from '../../activity-services';
import { headFrame } from '../../frames';
import { drawNowhere } from '../drawing-in-node';
import { fake } from '../fake';

drawNowhere();

/** A page with these activities, and what they do to it. */
function page(listed: readonly Activity[] = registered) {
  const opened = activityServices();
  const { services, mouse, settings, headset, study } = opened;
  const seen = {
    mirror: null as Side | null,
    scene: studioScene,
    orbit: true,
    palette: null as string | null,
  };
  const recorder = new Recorder();
  const options = fake<ActivitiesOptions>({
    ...services,
    seed: 5,
    stage: {
      studio: services.stage.studio,
      view: {
        ...services.stage.view,
        setScene(scene: CameraScene) {
          seen.scene = scene;
        },
        setOrbit(on) {
          seen.orbit = on;
        },
      },
      placeMirror(side) {
        seen.mirror = side;
      },
    },
    mouse,
    avatar: {
      ...services.avatar,
      setSeatPalette(palette: string | null) {
        seen.palette = palette;
      },
    },
    onArrival: () => undefined,
  });
  const activities = new Activities({ ...options, activities: listed, recorder });
  const parts = fake<StageParts>({ settings, headset, ...noSession, recorder, activities, study });
  const source = new TrackingSource(parts, noPointers, createActor());
  const tracked = (time: number) => source.read(time, undefined);
  return { ...opened, activities, seen, recorder, tracked };
}

/** A page whose user is on the range. */
async function range() {
  const opened = page();
  await opened.activities.goTo('archery');
  const archery = () => opened.activities.openedOf('archery') as ArcheryActivity;
  return { ...opened, archery, layout: () => archery().play.targets };
}

test('the activities of the page are archery and the ball game', () => {
  expect(registered.map(({ name }) => name)).toEqual(['archery', 'ball']);
});

test('every game of studies has a runner on this page', async () => {
  const { activities, settings, writer } = page();
  const runners = await createRunners(fake<StageParts>({ activities, settings, writer }));
  expect(Object.keys(runners)).toEqual(expect.arrayContaining([...gameNames]));
});

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

  test('a request on the way to the range is not taken up there', async () => {
    const { activities, places } = page();
    await Promise.all([activities.goTo('archery'), activities.goTo('ball')]);
    expect(activities.name).toBe('archery');
    expect(places).toHaveLength(1);
  });

  test('camera and mirror go along to the range, and back', async () => {
    const { activities, seen, places } = page();
    await activities.goTo('archery');
    expect(seen).toMatchObject({ scene: rangeScene, mirror: 'right' });
    await activities.goTo('studio');
    expect(seen).toMatchObject({ scene: studioScene, mirror: null });
    expect(places.at(-1)).toBeNull();
  });

  test('a court without downloadable bodies yields a notice, and the user stays at the mirror', async () => {
    // Nothing is served there.
    vi.stubGlobal('location', { href: 'http://127.0.0.1:9/' });
    const { activities, notices, seen } = page();
    await activities.goTo('ball');
    expect(activities.name).toBe('studio');
    expect(activities.arriving).toBe(false);
    expect(seen).toMatchObject({ scene: studioScene });
    expect(notices).toEqual([
      { level: 'error', text: expect.stringMatching(/^The ball court could not be opened: mannequin\.vrm: /) },
    ]);
  });
});

describe('a round', () => {
  const opened = range();

  test('restarts with a rule that counts differently, and continues with another hand', async () => {
    const { archery, layout } = await opened;
    const begun = layout();
    archery().setRules({ bowSide: 'right' });
    archery().setRules({ oneHanded: true });
    expect(layout()).toBe(begun);
    archery().setRules({ everyHitCounts: true });
    expect(layout()).not.toEqual(begun);
  });

  test('keeps what was chosen for the next visit, and the mirror changes sides with the bow', async () => {
    const { activities, archery, settings, seen, kept } = await opened;
    archery().setRules({ bowSide: 'left' });
    activities.show(1, null);
    expect(settings.bowSide).toBe('left');
    expect(kept.at(-1)).toEqual({ bowSide: 'left' });
    expect(seen.mirror).toBe('right');
    archery().setRules({ bowSide: 'right' });
    activities.show(2, null);
    expect(seen.mirror).toBe('left');
  });

  test('gives a seated player targets as high for the eyes as a standing one’s', async () => {
    const { activities, archery, headset, layout } = await opened;
    const targetsFor = (eyeHeight: number) => {
      activities.play(headFrame(eyeHeight, eyeHeight), nothingPressed);
      archery().startRound(8, 70);
      return layout().map(({ centre }) => centre.y);
    };
    headset.worn = true;
    const seated = targetsFor(1.2);
    const standing = targetsFor(1.6);
    headset.worn = false;
    expect(seated).toHaveLength(4);
    for (const [index, height] of standing.entries()) expect(height - (seated[index] ?? 0)).toBeCloseTo(0.4, 6);
  });

  test('starts anew with every change where the built-in archer shoots: its hands are the rules', async () => {
    const { archery, layout } = await opened;
    archery().chooseShooter('actor');
    const begun = layout();
    archery().setRules({ bowSide: 'left' });
    expect(layout()).not.toEqual(begun);
  });

  test('is shot by whom the user chooses, where a recording replays there too', async () => {
    const { archery, recorder, tracked } = await range();
    const ofRecording = headFrame(1, 1.9);
    const recording = { device: 'a test', rateHz: 60, calibration: null, frames: [ofRecording, headFrame(2, 1.9)] };
    for (const shooter of ['mouse', 'actor'] as const) {
      recorder.load('tall.json', recording);
      recorder.replay();
      expect(tracked(10)?.head).toEqual(ofRecording.head);
      archery().chooseShooter(shooter);
      expect(tracked(10.1)?.head.position.y).toBeLessThan(1.75);
      expect([recorder.mode, recorder.name]).toEqual(['idle', 'tall.json']);
    }
  });

  test('is a new one for a player who comes back, with the next layout', async () => {
    const [left, stayed] = await Promise.all([range(), range()]);
    const first = left.layout();
    expect(first).toEqual(stayed.layout());
    await left.activities.goTo('studio');
    await left.activities.goTo('archery');
    stayed.archery().restart();
    expect(left.layout()).not.toEqual(first);
    expect(left.layout()).toEqual(stayed.layout());
  });

  test('is aimed by the mouse where it was chosen; the camera turns with it everywhere else', async () => {
    const { activities, archery, seen, aims } = await opened;
    expect([aims.enabled, seen.orbit]).toEqual([false, true]);
    archery().chooseShooter('mouse');
    expect([aims.enabled, seen.orbit]).toEqual([true, false]);
    await activities.goTo('studio');
    expect([aims.enabled, seen.orbit]).toEqual([false, true]);
  });
});

describe('a player who takes the headset off', () => {
  /** The range of a page whose headset is put on and taken off. */
  async function worn() {
    const opened = await range();
    const { activities, headset, study } = opened;
    const nothing = () => undefined;
    const parts = fake<InputParts>({
      headset: { pictureRateHz: 72, visibility: 'none' },
      recorder: new Recorder(),
      timing: new FrameTiming(() => 0),
      stage: { view: { recentre: nothing } },
      body: { discontinuity: () => activities.current?.discontinuity?.() },
      activities,
      study,
      onChange: nothing,
    });
    const controls = fake<Controls>({ show: nothing, setWorn: nothing, layOut: nothing });
    const changes = new SessionChanges(
      parts,
      controls,
      fake<PassthroughHost>({ sessionChanged: async () => undefined }),
    );
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

  test('at full draw shoots no arrow: it returns to the quiver before the bow moves', async () => {
    const { activities, archery, enter, leave } = await worn();
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
    expect(archery().probe()?.draw).toBeGreaterThan(0.3);
    leave();
    hold(0, nothingPressed);
    expect(archery().probe()).toMatchObject({ phase: 'ready', arrowsLeft: 5, stage: 'empty' });
  });

  test('aims again by the mouse chosen at the desk, also on a range opened in VR', async () => {
    const { activities, archery, seen, aims, enter, leave } = await worn();
    archery().chooseShooter('mouse');
    enter();
    await activities.goTo('studio');
    await activities.goTo('archery');
    leave();
    expect([aims.enabled, seen.orbit]).toEqual([true, false]);
  });
});

describe('a round in a study', () => {
  const opened = range();

  test('is started by the study alone, with its layout, its time and its signal', async () => {
    const { activities, archery, settings, study, layout } = await opened;
    const begun = layout();
    study.run = studyRun();
    archery().restart();
    archery().setRules({ everyHitCounts: true });
    expect(layout()).toBe(begun);
    archery().startRound(42, 30);
    expect(layout()).not.toEqual(begun);
    expect(settings).toMatchObject({ seconds: 30, everyHitCounts: false });
    activities.play(headFrame(1, 1.6), nothingPressed);
    expect(archery().probe()?.phase).toBe('running');
    expect(archery().probe()?.secondsLeft).toBeCloseTo(30, 1);
  });

  test('passes every frame to its trial', async () => {
    const { activities, archery, settings, writer, study } = await opened;
    const runner = createArcheryRunner({
      settings,
      writer,
      opened: archery,
      open: async () => archery(),
      leave: () => undefined,
    });
    study.runners = { archery: runner };
    runner.start({ seed: 3, seconds: 1 });
    for (let time = 2; time < 4; time += 1 / 30) activities.play(headFrame(time, 1.6), nothingPressed);
    expect(runner.end).toMatchObject({ ended: 'time', score: 0 });
  });

  test('has no built-in archer while its participant does not play', async () => {
    const { activities, study } = await opened;
    study.run = studyRun();
    expect(activities.act(5)).not.toBeNull();
    study.run = studyRun({ idle: true });
    expect(activities.act(5.1)).toBeNull();
  });
});

/** A small third activity that writes down what the shell asks of it. */
function darts(done: string[]) {
  const activity: Activity = {
    name: 'darts',
    title: 'Darts',
    place: 'The dartboard',
    load: async ({ layout, place, setSound }) => ({
      scene: dartScene,
      mirrorSide: 'right',
      palette: 'red',
      act: (time) => ({ frame: headFrame(time, 1.5), buttons: nothingPressed }),
      update(frame) {
        done.push(`update at ${frame.time} s`);
        return [{ side: 'left', strength: 1, seconds: 0.02 }];
      },
      send: () => void done.push('send'),
      grasp: () => true,
      show: (_, frame) => void done.push(frame ? 'show' : 'show without a head'),
      point: (_, press) => (press ? { distance: 1, owner: 'darts', id: 'board' } : null),
      setAway: (away) => void done.push(`away ${away}`),
      banner: () => 'The dartboard is wet.',
      menu: () => ({
        entries: [{ id: 'quiet', label: 'No sound', act: () => setSound(false) }],
        sheet: null,
        notice: null,
        hint: 'Throw!',
      }),
      probe: () => ({ name: 'darts', seed: layout.seed, participant: place?.participant ?? null }),
      dispose: () => void done.push('dispose'),
    }),
    createRunner: async (services) => ({
      prepare: async (place) => void (await services.open(place)),
      start: ({ seed }) => void done.push(`start ${seed}`),
      played: () => void done.push('played'),
      take: () => [],
      waitingFor: null,
      pausedByOther: false,
      end: null,
      interrupted: false,
      pause: () => undefined,
      abort: () => services.leave(),
      assists: () => [],
    }),
  };
  return activity;
}

const dartScene: CameraScene = { ...rangeScene, free: true };

describe('a third activity', () => {
  /** A page whose registry lists a third activity. */
  function dartsPage() {
    const done: string[] = [];
    return { ...page([...registered, darts(done)]), done };
  }

  test('is entered by its name and gets the camera, mirror and colours that it wants', async () => {
    const { activities, seen, done } = dartsPage();
    await activities.goTo('darts');
    expect(activities.name).toBe('darts');
    expect(seen).toEqual({ mirror: 'right', scene: dartScene, orbit: true, palette: 'red' });
    await activities.goTo('archery');
    expect(done).toEqual(['dispose']);
    expect(seen).toMatchObject({ scene: rangeScene, palette: null });
  });

  test('is driven frame by frame', async () => {
    const { activities, tracked, settings, done } = dartsPage();
    await activities.goTo('darts');
    Object.assign(settings, { actor: true });
    const frame = tracked(7);
    if (!frame) throw new Error('its own player moves nobody');
    expect(frame.head.position.y).toBe(1.5);
    expect(activities.play(frame, nothingPressed)).toEqual([{ side: 'left', strength: 1, seconds: 0.02 }]);
    activities.current?.send?.(
      frame,
      { head: frame.head, leftHand: null, rightHand: null, body: null },
      unknownFingers,
    );
    activities.show(7, frame);
    activities.show(7.1, null);
    activities.current?.setAway?.(true);
    expect(done).toEqual(['update at 7 s', 'send', 'show', 'show without a head', 'away true']);
    const ray = { origin: vec3(0, 1.6, 0), direction: vec3(0, 0, -1) };
    expect([activities.current?.point?.(ray, false), activities.current?.point?.(ray, true)]).toMatchObject([
      null,
      { distance: 1 },
    ]);
  });

  test('has its button and its part in the menu of the headset', async () => {
    const { activities, settings, writer } = dartsPage();
    const actions = {} as VrMenuActions;
    const state = () =>
      menuStateOf(
        fake<StageParts>({
          activities,
          settings,
          body: { estimator: 'ik', unavailableEstimators: {} },
          notices: { current: () => [] },
          headset: { passthrough: null, passthroughOffered: false },
        }),
        fake<CalibrationControl>({ step: null }),
        null,
      );
    const labels = () => menuButtons(state(), actions).map(({ label }) => label);
    expect(labels()).toContain('Darts');
    await activities.goTo('darts');
    expect(labels()).toEqual(expect.arrayContaining(['To the mirror', 'No sound']));
    expect(state().notice).toBe('Throw!');
    writer.change({ sound: true });
    menuButtons(state(), actions)
      .find(({ label }) => label === 'No sound')
      ?.act();
    expect(settings.sound).toBe(false);
  });

  test('is played as a task of a study, at the place that the study gives', async () => {
    const { activities, settings, writer, study, done } = dartsPage();
    const runners = await createRunners(fake<StageParts>({ activities, settings, writer }));
    expect(Object.keys(runners)).toEqual([...registered.map(({ name }) => name), 'darts']);
    Object.assign(study, { run: studyRun(), runners });
    const { darts } = runners;
    await darts?.prepare({
      participant: 'P02',
      members: ['P02'],
      seconds: 9,
      afterAbsence: 'repeat',
      seat: async () => ({ room: 'here', token: '' }),
    });
    expect(activities.current?.probe?.()).toEqual({ name: 'darts', seed: 5, participant: 'P02' });
    darts?.start({ seed: 3, seconds: 9 });
    activities.play(headFrame(1, 1.6), nothingPressed);
    darts?.abort();
    await vi.waitFor(() => expect(activities.name).toBe('studio'));
    expect(done).toEqual(['start 3', 'update at 1 s', 'played', 'dispose']);
  });
});
