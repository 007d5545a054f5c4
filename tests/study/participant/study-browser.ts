import 'fake-indexeddb/auto';
import { IDBFactory } from 'fake-indexeddb';
import {
  type Calibration,
  createPageClock,
  defaultCalibration,
  type EstimatorName,
  type TrackingFrame,
} from 'threepoint/core';
import type { Side } from 'threepoint/math';
import { expect, vi } from 'vitest';
import { createParticipantClient } from '../../../src/study/client/study-client';
import type { Embodiment } from '../../../src/study/model/plan/embodiment';
import type { DeviceProblem } from '../../../src/study/model/plan/remote-setup';
import type { FrameListener } from '../../../src/study/model/records/trial-log';
import type { Invited, StudyForm } from '../../../src/study/participant/forms/study-form';
import { inertSeconds } from '../../../src/study/participant/inert-sheet';
import type { StudyScreen } from '../../../src/study/participant/questions/study-screen';
import type { StudyAddressBar, StudyDisplay, StudyPage } from '../../../src/study/participant/study-page';
import { StudyVisit } from '../../../src/study/participant/study-visit';
import type { StudyHost } from '../../../src/study/participant/trial/study-host';
import type { TaskEnd, TaskEvent, TaskPlace, TaskRunner } from '../../../src/study/participant/trial/task-runner';
import type { StudyServer } from './study-server';

/** A clock that the test advances, with its timers. */
class StandingClock {
  #now = 1e9;
  #due: { readonly at: number; readonly act: () => void }[] = [];

  now = (): number => this.#now;

  after = (delayMs: number, act: () => void): (() => void) => {
    const timer = { at: this.#now + delayMs / 1000, act };
    this.#due.push(timer);
    return () => {
      this.#due = this.#due.filter((other) => other !== timer);
    };
  };

  /** Suspends the machine: timers that are due meanwhile run when it resumes. */
  sleep(seconds: number): void {
    this.#now += seconds;
  }

  pass(seconds: number): void {
    const end = this.#now + seconds;
    for (;;) {
      const next = this.#due.filter(({ at }) => at <= end).toSorted((a, b) => a.at - b.at)[0];
      if (!next) break;
      this.#due = this.#due.filter((other) => other !== next);
      this.#now = Math.max(this.#now, next.at);
      next.act();
    }
    this.#now = end;
  }
}

/** The content at the desk and in the headset; `reaches` and `until` wait for content. */
export class ShownParts implements StudyDisplay {
  form: StudyForm | null = null;
  screen: StudyScreen | null = null;
  /** The screen before the eyes of the participant who wears the headset. */
  inHeadset: StudyScreen | null = null;
  shown = 'opening';
  #waiting: { readonly isTrue: (display: ShownParts) => boolean; readonly resolve: () => void }[] = [];

  show(screen: StudyScreen | null, inHeadset: boolean): void {
    this.form = null;
    this.screen = screen;
    this.inHeadset = inHeadset ? screen : null;
    this.#note(screen?.id ?? 'playing');
  }

  ask(form: StudyForm, inHeadset: StudyScreen | null = null): void {
    this.form = form;
    this.screen = null;
    this.inHeadset = inHeadset;
    this.#note(form.kind);
  }

  reaches(id: string): Promise<void> {
    return this.until(() => this.shown === id);
  }

  /** Resolves when something is shown of which this is true. */
  until(isTrue: (display: ShownParts) => boolean): Promise<void> {
    if (isTrue(this)) return Promise.resolve();
    return new Promise((resolve) => this.#waiting.push({ isTrue, resolve }));
  }

  /** The form on the desk, which must be of this kind. */
  asked<Kind extends StudyForm['kind']>(kind: Kind): Extract<StudyForm, { kind: Kind }> {
    expect(this.shown).toBe(kind);
    return this.form as Extract<StudyForm, { kind: Kind }>;
  }

  /** Lets a moment pass, after which a sheet that has just appeared takes presses. */
  wait: () => void = () => undefined;

  /** Presses a button of the screen, as soon as it can be pressed. */
  press(id: string): void {
    const find = () => this.screen?.buttons.find((button) => button.id === id);
    if (find()?.look === 'off') this.wait();
    const found = find();
    if (!found || found.look === 'off') throw new Error(`"${id}" cannot be pressed on the screen "${this.shown}"`);
    found.act();
  }

  #note(id: string): void {
    this.shown = id;
    const waiting = this.#waiting;
    this.#waiting = waiting.filter(({ isTrue }) => !isTrue(this));
    for (const one of waiting) if (!this.#waiting.includes(one)) one.resolve();
  }
}

/** A game of one shot, whose hit by the test ends it. After `abort` it must be prepared again, as the court must. */
export class OneShotGame implements TaskRunner {
  readonly waitingFor = null;
  readonly pausedByOther = false;
  end: TaskEnd | null = null;
  interrupted = false;
  running = false;
  paused = false;
  /** Why the game cannot be loaded; null: it can. */
  refusal: string | null = null;
  readonly places: TaskPlace[] = [];
  readonly seeds: number[] = [];
  #here = false;
  #happened: TaskEvent[] = [];

  async prepare(place: TaskPlace): Promise<void> {
    this.places.push(place);
    if (this.refusal !== null) throw new Error(this.refusal);
    this.#here = true;
  }

  start({ seed }: { readonly seed: number }): void {
    this.seeds.push(seed);
    this.running = this.#here;
    this.end = null;
    this.interrupted = false;
  }

  /** Loses the game, as when its server has restarted. */
  breakOff(): void {
    this.interrupted = this.running;
  }

  hit(points: number): void {
    if (!this.running) return;
    this.#happened.push({ type: 'shot' }, { type: 'hit', time: 1, points });
    this.end = { seconds: 5, ended: 'arrows', score: points, maximum: 50 };
  }

  take(): readonly TaskEvent[] {
    const taken = this.#happened;
    this.#happened = [];
    return taken;
  }

  pause(on: boolean): void {
    this.paused = on;
  }

  abort(): void {
    this.#here = false;
    this.running = false;
    this.end = null;
    this.interrupted = false;
  }

  assists(): readonly string[] {
    return [];
  }
}

/** The calibration of the page before a study begins: that of its user or of the previous participant. */
export const ofAnother: Calibration = { eyeHeight: 1.8, armSpan: 1.74 };

/** The page around the study: a headset to be put on and taken off, bodies that load, two games. */
class TestHost implements StudyHost {
  readonly games = { archery: new OneShotGame(), ball: new OneShotGame() };
  readonly runners = this.games;
  worn = false;
  /** null: not measured. */
  measures: Calibration | null = ofAnother;
  embodiment: Embodiment = { estimator: 'hands-only' };
  /** Estimators that this page cannot load. */
  readonly missing = new Set<EstimatorName>();
  bowSide: Side | null = null;
  actor: boolean | null = null;
  #listener: FrameListener | null = null;

  async enterVr(): Promise<void> {
    this.worn = true;
  }
  inSession = (): boolean => this.worn;
  /** The tracked height of the eyes [m]. */
  eyes = 1.6;
  fault: DeviceProblem | null = null;
  free: { readonly width: number; readonly depth: number } | null = null;
  deviceProblem = (): DeviceProblem | null => this.fault;
  room = () => this.free;
  calibration = (): Calibration => this.measures ?? defaultCalibration;
  setCalibration(calibration: Calibration | null): void {
    this.measures = calibration;
  }
  async embody(embodiment: Embodiment): Promise<void> {
    if (this.missing.has(embodiment.estimator)) throw new Error('The body of this round could not be loaded.');
    this.embodiment = embodiment;
  }
  estimator = (): EstimatorName => this.embodiment.estimator;
  setActor(on: boolean): void {
    this.actor = on;
  }
  setBowSide(side: Side): void {
    this.bowSide = side;
  }
  device = () => ({ name: 'Test headset', refreshRateHz: 72, input: 'controllers' }) as const;
  listenToFrames(listener: FrameListener | null): void {
    this.#listener = listener;
  }
  drew(): void {
    this.#listener?.({ frame: 5 }, false);
  }
}

const ahead = { x: 0, y: 0, z: 0, w: 1 };

/** A person of 1.6 m eye height who stretches both arms forward, as calibration wants it; `raised`: above the head. */
function stretched(time: number, raised: boolean, eyes: number): TrackingFrame {
  const lower = 1.6 - eyes;
  const hand = (x: number) =>
    ({
      position: raised ? { x, y: 1.9 - lower, z: -0.1 } : { x, y: 1.33 - lower, z: -0.56 },
      orientation: ahead,
      tracking: 'tracked',
    }) as const;
  return {
    time,
    head: { position: { x: 0, y: eyes, z: 0 }, orientation: ahead, tracking: 'tracked' },
    leftHand: hand(-0.18),
    rightHand: hand(0.18),
  };
}

export type Tab = Awaited<ReturnType<ReturnType<typeof browser>['open']>>;

/**
 * A browser with its own storage, in which P01's place is opened; tabs share its storage and see each other's locks.
 * `storageLimitMs` is how long a page waits for its storage [ms].
 */
export function browser(server: StudyServer, storageLimitMs?: number) {
  vi.stubGlobal('indexedDB', new IDBFactory());
  const locks = new Map<string, object>();

  /** Loads the page with this address; by default that of the link of P01. */
  async function open(link: Partial<{ [Part in keyof Invited]: string | null }> & { readonly study?: string } = {}) {
    const tab = {};
    const { participant = 'P01', invitation = server.invitation, study = server.plan.id } = link;
    vi.stubGlobal('navigator', {
      locks: {
        async request(name: string, _: unknown, use: (lock: object | null) => unknown) {
          const free = !locks.has(name);
          if (free) locks.set(name, tab);
          await use(free ? { name } : null);
        },
      },
    });
    const clock = new StandingClock();
    const display = new ShownParts();
    display.wait = () => clock.pass(inertSeconds + 0.5);
    const host = new TestHost();
    let go: (to: Invited | 'reload') => void = () => undefined;
    const wentTo = new Promise<Invited | 'reload'>((resolve) => {
      go = resolve;
    });
    const address: StudyAddressBar = {
      invitation: () => invitation,
      goTo: (place) => go(place),
      reload: () => go('reload'),
      withdrawalPage: () => `${server.origin}/withdraw?study=${study}`,
      reloadWhenChanged: () => undefined,
    };
    const languages = ['en-GB'];
    const page: StudyPage = { display, address, languages, now: clock.now, after: clock.after, storageLimitMs };
    const visit = new StudyVisit({ study, participant }, createParticipantClient(server.origin), host, page);
    await visit.enter();
    let stamp = 100;
    const pageClock = createPageClock(() => stamp * 1000);
    return {
      visit,
      display,
      host,
      /** Resolves with the address to which the page is sent. */
      wentTo,
      /**
       * Resolves when the server has all there is now: an exchange under way may have begun before, a second one has
       * not.
       */
      async exchange(): Promise<void> {
        await visit.flow?.exchange();
        await visit.flow?.exchange();
      },
      /** Advances the clock without drawing a frame. */
      pass: (seconds: number) => clock.pass(seconds),
      /** Suspends the machine: the time of day advances, and with `both` the time of frames too. */
      sleep(seconds: number, both: boolean): void {
        clock.sleep(seconds);
        if (both) stamp += seconds;
        clock.pass(0);
      },
      /** Draws this many seconds at 30 Hz; `raised`: with both hands above the head. */
      draw(seconds: number, raised = false): void {
        for (let i = 0; i < seconds * 30; i++) {
          stamp += 1 / 30;
          clock.pass(1 / 30);
          const time = pageClock.tick(stamp * 1000);
          visit.flow?.frame(time, stretched(time, raised, host.eyes));
          host.drew();
        }
      },
      wear(on: boolean): void {
        host.worn = on;
        visit.flow?.sessionChanged();
      },
      /** Closes the page: the browser releases its locks. */
      close(): void {
        for (const [name, owner] of locks) if (owner === tab) locks.delete(name);
      },
    };
  }
  return { open };
}
