import type { Page } from '@playwright/test';
import { parsePlan, type StudyPlan } from '../../src/study/model/plan/plan';
import { scheduleFor } from '../../src/study/model/plan/schedule';
import type { Point } from '../emulated-headset';
import { distance, enterVr, expect, keepPicture, probe } from '../page-fixture';
import { calibrate, consentAndFillIn, press, reaches, stretched, takePart, tenHertz, test } from './study-participant';
import { experimenter, shortStudy, withoutPractice } from './study-server';

const conditions = [
  {
    id: 'late',
    label: '100 ms later',
    estimator: 'ik',
    avatar: 'woman',
    mirror: false,
    upperBodyOnly: true,
    latencyMs: 100,
  },
  {
    id: 'bad-tracking',
    label: 'Noise and lost hands',
    estimator: 'learned',
    avatar: 'mannequin',
    mirror: true,
    upperBodyOnly: false,
    trackerNoise: { positionMm: 10, rotationDegrees: 1 },
    dropouts: { perMinute: 20, seconds: 2 },
  },
];

function plan(): StudyPlan {
  const short = withoutPractice(shortStudy('conditions'));
  const question = { id: 'mine', text: 'It felt as if the virtual body were my own.' };
  const body = { id: 'own', title: 'Body', answer: { kind: 'likert', from: 1, to: 7 }, questions: [question] };
  const tasks = short.tasks.map((task) => ({
    ...task,
    calibrateBeforeBlock: false,
    questionnaire: 'own',
  }));
  return parsePlan(JSON.stringify({ ...short, conditions, tasks, questionnaires: [body] }), 'conditions.json');
}

/** The tracked and the drawn position of a hand in a frame. */
interface Sample {
  readonly time: number;
  readonly tracked: Point;
  readonly drawn: Point;
}

/** Moves the right hand up and down for so many frames, `reach` [m] to either side, and notes each of them. */
const follow = (page: Page, frames: number, reach: number): Promise<readonly Sample[]> =>
  page.evaluate(
    async ([frames, reach]) => {
      const samples: Sample[] = [];
      const { right } = window.emulatedDevice.controllers;
      for (let i = 0; i < frames; i++) {
        right.position.set(0.19, 1.3 + reach * Math.sin(i / 2), -0.4);
        await new Promise<void>((resolve) => requestAnimationFrame(() => resolve()));
        const { tracking, avatar } = window.threepoint!.probe();
        const drawn = avatar.joints.rightHand;
        if (tracking?.rightHand && drawn) samples.push({ time: tracking.time, tracked: tracking.rightHand, drawn });
      }
      return samples;
    },
    [frames, reach] as const,
  );

/** Returns the tracked position of the hand at a time, interpolated between two frames. */
function trackedAt(samples: readonly Sample[], time: number): Point {
  const next = samples.findIndex((sample) => sample.time >= time);
  const [before, after] = [samples[next - 1], samples[next]];
  if (!before || !after) throw new Error(`nothing was tracked around ${time} s`);
  const share = (time - before.time) / (after.time - before.time);
  const [x, y, z] = before.tracked.map((value, axis) => value + share * ((after.tracked[axis] ?? 0) - value));
  return [x ?? 0, y ?? 0, z ?? 0];
}

/** The drawn hand is where the tracked one was 100 ms before, and clearly not where it is. */
async function expectLate(page: Page): Promise<void> {
  const samples = await follow(page, 60, 0.25);
  // The way between two frames is taken for straight, by the page and here; the first tenth of a second is before the
  // movement.
  const moving = samples.slice(12);
  for (const { time, drawn } of moving) expect(distance(drawn, trackedAt(samples, time - 0.1))).toBeLessThan(0.004);
  const behind = moving.map(({ tracked, drawn }) => distance(tracked, drawn));
  expect(Math.max(...behind)).toBeGreaterThan(0.08);
}

/** The drawn hand trembles about the tracked one, and is lost now and then. */
async function expectBadTracking(page: Page): Promise<void> {
  const samples = await follow(page, 200, 0);
  const away = samples.map(({ tracked, drawn }) => distance(tracked, drawn)).toSorted((a, b) => a - b);
  expect(away[Math.floor(away.length / 4)]).toBeGreaterThan(0.005);
  expect(away[Math.floor(away.length / 4)]).toBeLessThan(0.03);
  expect(away.at(-1)).toBeGreaterThan(0.1);
}

test('every condition changes the body: method, avatar, mirror, upper body, latency, noise and lost hands @full', async ({
  page,
  origin,
}) => {
  test.setTimeout(240_000);
  const study = plan();
  await experimenter(origin).addStudy(study, true);
  const headset = await takePart(page, origin, study.id, 'P01');
  await consentAndFillIn(page);
  await enterVr(page, tenHertz);
  await headset.place(stretched);
  await calibrate(page);
  for (const step of scheduleFor(study, 'P01').steps) {
    if (step.kind !== 'trial') continue;
    await reaches(page, 'trial-ready', 60_000);
    const condition = conditions.find(({ id }) => id === step.condition);
    await expect.poll(async () => (await probe(page)).estimator, { timeout: 30_000 }).toBe(condition?.estimator);
    await expect
      .poll(async () => (await probe(page)).avatar.name, { timeout: 30_000 })
      .toMatch(new RegExp(condition?.avatar ?? '', 'i'));
    const checked = (label: string) => page.getByRole('switch', { name: label, includeHidden: true }).isChecked();
    expect(await checked('Mirror')).toBe(condition?.mirror);
    expect(await checked('Upper body only')).toBe(condition?.upperBodyOnly);
    await headset.place(stretched);
    if (step.condition === 'late') await expectLate(page);
    else await expectBadTracking(page);
    await keepPicture(page, `study-condition-${step.condition}`);
    await press(page, 'start');
    await reaches(page, 'question-mine', 60_000);
    await press(page, 'answer-4');
    await press(page, 'submit');
  }
  await reaches(page, 'end');
});
