import { createEstimator, defaultCalibration, type TrackingFrame, unknownFingers } from 'threepoint/core';
import {
  fromAxisAngle,
  identity,
  multiply,
  type Pose,
  right,
  subtract,
  transformPoint,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { Pointing, TrackedSession } from 'threepoint/webxr';
import type { SimulatedInput } from 'threepoint-games';
import { createBallLoopbackHost } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import type { ArcheryFrame } from '../../../../src/page/archery/archery-play';
import { CourtInput } from '../../../../src/page/ball/court-input';
import type { BallPlay } from '../../../../src/page/ball/match/ball-play';
import { createActor } from '../../../../src/page/emulator/actor';
import { Pointers } from '../../../../src/page/shell/input/pointers';
import { TrackingSource } from '../../../../src/page/shell/input/tracking-source';
import type { StageParts } from '../../../../src/page/shell/stage/stage-parts';
import { Recorder } from '../../../../src/page/studio/recorder';
import { poseOf } from '../../../threepoint/core/estimation/drawn';
import { controller, fakeHeadset, type Input } from '../../../threepoint/xr/fake-headset';
import { archeryPage, ballPage } from '../../playing';
import { fake } from '../fake';

const eyes = vec3(0, defaultCalibration.eyeHeight, 0);

/** The pose at the eyes whose −Z points at a place. */
function lookingAt(target: Vec3, from: Vec3 = eyes): Pose<'floor'> {
  const { x, y, z } = subtract(target, from);
  const yaw = fromAxisAngle(up, Math.atan2(-x, -z));
  const pitch = fromAxisAngle(right, Math.atan2(y, Math.hypot(x, z)));
  return { position: from, orientation: multiply(yaw, pitch) };
}

/** A session of a headset that reports no hands, in which an activity acts. */
function handless(act: (time: number) => SimulatedInput | null, settings = { gaze: false }) {
  const headset = fakeHeadset();
  const tracking = new TrackedSession({ ...headset, pointing: new Pointing(headset.session) });
  const parts = fake<StageParts>({
    settings: {
      actor: false,
      get gaze() {
        return settings.gaze;
      },
    },
    headset: { emulator: null, worn: true, tracking },
    tracker: { tracking, read: (...at: Parameters<TrackedSession['read']>) => tracking.read(...at) },
    recorder: new Recorder(),
    activities: { current: null, act },
    study: { run: null },
  });
  const pointers = new Pointers(parts);
  const source = new TrackingSource(parts, pointers, createActor());
  let time = 10;
  return {
    ...headset,
    pointers,
    settings,
    /** Reads a frame; returns it with the buttons of its hands. */
    read() {
      time += 1 / 72;
      const frame = source.read(time, headset.frame);
      if (!frame) throw new Error('the head is not seen');
      return { frame, buttons: source.buttons };
    },
  };
}

type Handless = ReturnType<typeof handless>;

/** Archery in such a session. */
function range(settings = { gaze: false }) {
  const play = archeryPage();
  const page: Handless = handless((time) => {
    const steering = page.pointers.steering;
    return steering && play.steer(time, steering);
  }, settings);
  const happened: string[] = [];
  return {
    ...page,
    play,
    happened,
    pass(seconds: number): ArcheryFrame {
      for (let i = 0; i < 72 * seconds; i++) {
        const { frame, buttons } = page.read();
        happened.push(...play.follow(frame, buttons).events.map(({ type }) => type));
      }
      return play.newest!;
    },
  };
}

const hits = ({ state }: ArcheryFrame) => state.arrows.map(({ landing }) => landing?.target ?? null);

/** The pinch of a device that reports hands only while they pinch, and aims by the eyes. */
const pinch = (ray: Pose<'floor'>): Input => ({
  ...controller('right', { position: vec3(0.2, 1.1, -0.3), orientation: identity }),
  profiles: ['generic-hand-select'],
  targetRayMode: 'transient-pointer',
  targetRaySpace: { at: ray },
});

describe('archery without hands', () => {
  test('a pinch that aims with the eyes draws, and shoots its target when it opens', () => {
    const { play, pass, setInputs, select } = range();
    pass(1.5);
    for (const target of [0, 1]) {
      const source = pinch(lookingAt(play.targets[target]!.centre));
      setInputs(source);
      select('selectstart', source);
      const { bow } = pass(1.8);
      expect(bow?.stage).toBe('anchored');
      select('selectend', source);
      setInputs();
      pass(2);
    }
    expect(hits(play.newest!)).toEqual([0, 1]);
  });

  test('a resting gaze nocks, draws and shoots; looking away puts the arrow back', () => {
    const { play, pass, setHead } = range({ gaze: true });
    pass(1.5);
    const lookAt = (at: Vec3) => setHead(lookingAt(at));
    lookAt(play.targets[2]!.centre);
    pass(1.2);
    expect(play.newest?.bow?.draw).toBeGreaterThan(0.1);
    lookAt(vec3(0, 5, -3));
    const { state } = pass(2);
    expect(state.arrowsLeft).toBe(5);
    lookAt(play.targets[2]!.centre);
    pass(3.5);
    expect(hits(play.newest!)).toEqual([2]);
    // A gaze that watches the arrow shoots no other one.
    pass(4);
    expect(play.newest?.state.arrowsLeft).toBe(4);
    lookAt(play.targets[3]!.centre);
    pass(4);
    lookAt(play.targets[1]!.centre);
    pass(0.5);
    lookAt(play.targets[0]!.centre);
    pass(4);
    expect(hits(play.newest!)).toEqual([2, 3, 0]);
  });

  test('hands that come back play at once and do not shoot the pointer’s arrow', () => {
    const { play, pass, setHead, setInputs, happened, pointers } = range({ gaze: true });
    pass(1.5);
    setHead(lookingAt(play.targets[0]!.centre));
    pass(1.4);
    const at = (x: number): Pose<'floor'> => ({ position: vec3(x, 1.1, -0.3), orientation: identity });
    setInputs(controller('left', at(-0.25)), controller('right', at(0.25)));
    pass(1);
    expect(pointers.steering).toBeNull();
    expect(happened).not.toContain('released');
    expect(play.newest?.state.arrowsLeft).toBe(5);
  });

  test('nothing plays for a user with still hands, nor without a gaze that was chosen', () => {
    const { pass, pointers, setInputs } = range();
    pass(4);
    expect([pointers.steering, pointers.offersGaze]).toEqual([null, true]);
    setInputs(controller('left', { position: vec3(0, 1, 0), orientation: identity }));
    pass(0.1);
    expect([pointers.steering, pointers.offersGaze]).toEqual([null, false]);
  });
});

describe('the ball game without hands', () => {
  test('by gaze: balls are taken, and leave for the basket that the gaze rests on', () => {
    const host = createBallLoopbackHost({ seed: 3, ball: { seconds: 600 } });
    const place = { place: null, settings: { actor: false }, headset: { worn: true, emulator: null } };
    const page: Handless = handless((time) => play.act(time, false), { gaze: true });
    const input = new CourtInput({ ...place, pointer: () => page.pointers.steering } as never, () => play);
    const play: BallPlay = ballPage(host, {
      seat: 0,
      bots: () => true,
      readyByItself: () => input.isActor,
      steering: () => input.steering(),
      seed: 7,
    });
    const estimator = createEstimator('ik', defaultCalibration);
    const events: string[] = [];
    const send = (frame: TrackingFrame) => play.sendPose(frame.time, poseOf(estimator, frame), unknownFingers);
    const pass = (seconds: number, until: () => boolean) => {
      for (let i = 0; i < 72 * seconds && !until(); i++) {
        const { time } = page.read().frame;
        play.begin(time);
        const { frame, buttons } = page.read();
        const seen = play.follow(frame.time, frame, buttons);
        for (const event of seen?.events ?? []) if ('player' in event && event.player === 0) events.push(event.type);
        send(frame);
        const basket = seen?.opening?.position ?? seen?.state.basket.position;
        if (basket) page.setHead(lookingAt(transformPoint(play.floorFromArena, basket)));
      }
      expect(until()).toBe(true);
    };
    pass(5, () => play.newest?.state.phase === 'ready');
    play.connection?.setReady(true);
    pass(10, () => play.newest?.state.phase === 'running');
    pass(20, () => events.filter((type) => type === 'thrown').length >= 2);
    expect(events).not.toContain('refused');
  });
});
