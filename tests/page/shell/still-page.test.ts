import { setImmediate } from 'node:timers/promises';
import fc from 'fast-check';
import { BodySolver } from 'threepoint';
import { type Calibration, type EstimatorName, TrackingDegradation, type TrackingFrame } from 'threepoint/core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { createActor } from '../../../src/page/emulator/actor';
import { createFrameLoop } from '../../../src/page/shell/frame-loop';
import { TrackingSource } from '../../../src/page/shell/input/tracking-source';
import { PageFrame } from '../../../src/page/shell/page-frame';
import type { Controls } from '../../../src/page/shell/panels/controls';
import { FrameTiming } from '../../../src/page/shell/session/frame-timing';
import type { PassthroughHost } from '../../../src/page/shell/stage/passthrough-host';
import type { StageParts } from '../../../src/page/shell/stage/stage-parts';
import { Recorder } from '../../../src/page/studio/recorder';
import { cases } from '../../nightly';
import { seed } from '../../threepoint/core/arbitraries';
import { bodies, jointsOf } from '../../threepoint/core/estimation/contract-subjects';
import type { Joints } from '../../threepoint/core/estimation/drawn';
import { openPlainModel, openShippedModel } from '../../threepoint/core/estimation/shipped-models';
import {
  expectSlow,
  expectStill,
  rate,
  settled,
  slowPerson,
  stillPerson,
  watched,
} from '../../threepoint/core/estimation/still-people';
import { noPointers } from '../activity-services';
import { fake } from './fake';

type Networks = ConstructorParameters<typeof BodySolver>[0]['networks'];

/**
 * A page in a session whose device reports these frames: what it draws of one, joint by joint. Only the device and the
 * picture are missing.
 */
async function openPage(estimator: EstimatorName, calibration: Calibration, networks: Networks) {
  const recorder = new Recorder();
  const body = new BodySolver({ estimator, calibration, networks });
  await body.setEstimator(estimator);
  const degradation = new TrackingDegradation();
  let reported: TrackingFrame | null = null;
  const headset = {
    observeFrame: () => undefined,
    worn: true,
    emulator: null,
    visibility: 'visible',
    buzz: () => undefined,
    commands: null,
    turnIfAsked: () => false,
  };
  const tracker = {
    avatar: null,
    tracking: null,
    read: (_: unknown, time: number) => reported && { ...reported, time },
    draw: () => undefined,
  };
  const activities = {
    current: null,
    mirror: 'never',
    act: () => null,
    play: () => [],
    grasp: () => false,
    show: () => undefined,
  };
  const faults: unknown[] = [];
  const parts = fake<StageParts>({
    settings: { actor: false, mirror: false },
    notices: { show: (_: unknown, fault: unknown) => faults.push(fault) },
    timing: { lastMs: 0 },
    degradation,
    tracker,
    body,
    recorder,
    difference: { observe: () => undefined },
    headset,
    activities,
    study: { run: null },
    stage: { look: () => undefined, draw: () => undefined },
    mocap: { frame: () => undefined, aside: 0 },
  });
  const source = new TrackingSource(parts, noPointers, createActor());
  const controls = fake<Controls>({ observe: () => undefined, point: () => undefined });
  const frame = new PageFrame(
    { ...parts, source, pointers: noPointers },
    controls,
    fake<PassthroughHost>({ update: () => undefined }),
  );
  const loop = createFrameLoop(frame, body, new FrameTiming(() => 0));
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
