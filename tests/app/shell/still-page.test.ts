import { setImmediate } from 'node:timers/promises';
import fc from 'fast-check';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { createFrameLoop } from '../../../src/app/shell/frame-loop';
import { createFrameTiming } from '../../../src/app/shell/frame-timing';
import { PageFrame, type PageFrameOptions } from '../../../src/app/shell/page-frame';
import { TrackingSource } from '../../../src/app/shell/tracking-source';
import { Recorder } from '../../../src/app/studio/recorder';
import type { Calibration } from '../../../src/core/body/calibration';
import type { EstimatorName } from '../../../src/core/estimation/pose-estimator';
import { nothingPressed } from '../../../src/core/games/button-presses';
import { ImpairedTracking } from '../../../src/core/tracking/impaired-tracking';
import type { TrackingFrame } from '../../../src/core/tracking/tracking-frame';
import { BareBody } from '../../../src/lib/bare-body';
import { createActor } from '../../../src/xr/actor';
import { seed } from '../../core/arbitraries';
import { bodies, jointsOf } from '../../core/estimation/contract-subjects';
import type { Joints } from '../../core/estimation/drawn';
import { openPlainModel, openShippedModel } from '../../core/estimation/shipped-models';
import {
  expectSlow,
  expectStill,
  rate,
  settled,
  slowPerson,
  stillPerson,
  watched,
} from '../../core/estimation/still-people';
import { cases } from '../../nightly';

type Networks = ConstructorParameters<typeof BareBody>[0]['networks'];

/** A page in a session whose device reports these frames: what it draws of one, joint by joint. Only the device and the picture are missing. */
async function openPage(estimator: EstimatorName, calibration: Calibration, networks: Networks) {
  const recorder = new Recorder();
  const body = new BareBody({ estimator, calibration, networks });
  await body.choose(estimator);
  const impaired = new ImpairedTracking();
  let reported: TrackingFrame | null = null;
  const headset = {
    worn: true,
    emulator: null,
    buttons: nothingPressed,
    visibility: 'visible',
    read: (_: unknown, time: number) => reported && { ...reported, time },
    buzz: () => undefined,
    takePress: () => false,
    turnByStick: () => false,
  };
  const activities = {
    name: 'studio',
    begin: () => undefined,
    act: () => null,
    watched: () => null,
    play: () => [],
    grasp: () => false,
    show: () => undefined,
  };
  const source = new TrackingSource({
    settings: { actor: false },
    headset,
    recorder,
    body,
    actor: createActor(),
    activities,
    study: { idle: false },
  });
  const faults: unknown[] = [];
  const parts = {
    settings: { mirror: false },
    notices: { show: (_: unknown, fault: unknown) => faults.push(fault) },
    source,
    impaired,
    body,
    recorder,
    difference: { observe: () => undefined },
    avatar: { current: null },
    headset,
    activities,
    controls: { observe: () => undefined, point: () => undefined },
    study: { run: null },
    stage: { look: () => undefined, draw: () => undefined },
    mocap: { frame: () => undefined, aside: 0 },
  };
  const loop = createFrameLoop(
    new PageFrame(parts as unknown as PageFrameOptions),
    body,
    createFrameTiming(() => 0),
  );
  return {
    /** Draws a frame, and lets a network that answers later answer. */
    async show(frame: TrackingFrame) {
      reported = frame;
      loop(frame.time * 1000, {} as XRFrame);
      if (body.provider === 'wasm') await setImmediate();
    },
    joints: () => jointsOf(body.pose!, calibration),
    async close() {
      expect(faults).toEqual([]);
      expect(body.estimator).toBe(estimator);
      await body.dispose();
    },
  };
}

/** Networks that outlive a page: one opened for all cases of a test. */
function openNetworks() {
  const shipped = openShippedModel('paper');
  return {
    networks: (async (name) =>
      name === 'learned' ? openPlainModel() : { ...(await shipped), dispose: async () => undefined }) as Networks,
    close: async () => (await shipped).dispose(),
  };
}

describe.each(bodies.filter(({ plain, name }) => plain || name !== 'learned'))('the page draws $label', ({ name }) => {
  let opened: ReturnType<typeof openNetworks>;
  beforeAll(() => {
    opened = openNetworks();
  });
  afterAll(() => opened.close());
  // Inference on the page's runtime costs.
  const runs = { seed, numRuns: cases(name === 'paper' ? 1 : 8), endOnFailure: true };

  test('a person who holds still: after two seconds still, hands within reach on their controllers', () =>
    fc.assert(
      fc.asyncProperty(stillPerson, async (person) => {
        const page = await openPage(name, person.calibration, opened.networks);
        for (let i = 0; i < settled; i++) await page.show(person.frame(i * rate));
        const drawn: Joints[] = [];
        for (let i = settled; i < settled + watched; i++) {
          await page.show(person.frame(i * rate));
          drawn.push(page.joints());
        }
        expectStill(drawn, person);
        await page.close();
      }),
      runs,
    ));

  test('no joint much further in a frame than hands that move slowly', () =>
    fc.assert(
      fc.asyncProperty(slowPerson, async ({ calibration, count, frame }) => {
        const page = await openPage(name, calibration, opened.networks);
        for (let i = -settled; i < 0; i++) await page.show(frame(i));
        const drawn: Joints[] = [];
        for (let i = 0; i <= count; i++) {
          await page.show(frame(i));
          drawn.push(page.joints());
        }
        expectSlow(drawn);
        await page.close();
      }),
      runs,
    ));
});
