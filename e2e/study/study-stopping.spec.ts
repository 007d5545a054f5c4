import { checkedPlan } from 'threepoint-study/model/plan/plan';
import type { PlacedPose } from '../emulated-headset';
import { enterVr, expect, keepPicture } from '../page-fixture';
import {
  consentAndFillIn,
  press,
  reaches,
  signIn,
  stretched,
  study,
  takePart,
  tenHertz,
  test,
} from '../study-participant';
import { experimenter, shortStudy } from '../study-server';

test('a participant with no one beside them is checked, asked whether to stop, and stops in the middle of a round by raising both hands, and the experimenter sees it @realtime', async ({
  page,
  origin,
}) => {
  test.setTimeout(480_000);
  const remote = { contact: 'Write to lab@example.org, or call 555 0100.', freeSpace: 2 };
  const short = shortStudy('stopping');
  const tasks = short.tasks.map((task) => ({
    ...task,
    trialSeconds: 15,
    calibrateBeforeBlock: false,
    questionnaire: 'well',
    tutorial: { ...task.tutorial, when: 'never' },
  }));
  const question = { id: 'sick', text: 'How sick do you feel?' };
  const well = { id: 'well', title: 'Well?', answer: { kind: 'likert', from: 0, to: 4 }, questions: [question] };
  const askToStop = [{ questionnaire: 'well', measure: 'sick', atLeast: 3 }];
  const plan = checkedPlan({ ...short, tasks, remote, questionnaires: [well], askToStop });
  await experimenter(origin).begin(plan, false);
  const headset = await takePart(page, origin, 'stopping', 'P01');
  await consentAndFillIn(page);
  await enterVr(page, tenHertz);
  await headset.place(stretched);
  await reaches(page, 'calibration');
  await press(page, 'calibrate');
  const seated = ({ position: [x, y, z], orientation }: PlacedPose): PlacedPose => ({
    position: [x, y - 0.8, z],
    orientation,
  });
  const { head, left, right } = stretched;
  await headset.place({ head: seated(head), left: seated(left), right: seated(right) });
  await reaches(page, 'setup', 90_000);
  // The sheet has come down to the eyes of a seated wearer, at 0.9 m.
  await expect.poll(async () => (await study(page)).targets.map(({ at: [, y] }) => y < 0.9)).toEqual([true, true]);
  await keepPicture(page, 'study-setup');
  await press(page, 'calibrate', true);
  await reaches(page, 'trial-ready', 90_000);
  await keepPicture(page, 'study-ready-to-stop');
  await press(page, 'start');
  await reaches(page, 'question-sick', 90_000);
  await press(page, 'answer-4');
  await press(page, 'submit');
  await reaches(page, 'unwell');
  await keepPicture(page, 'study-unwell');
  await press(page, 'go-on');
  await reaches(page, 'trial-ready', 60_000);
  await press(page, 'start');
  await expect.poll(async () => (await study(page)).running).toBe(true);
  const raised = (x: number) => ({ position: [x, 2, -0.1], orientation: stretched.head.orientation }) as const;
  await headset.place({ ...stretched, left: raised(-0.2), right: raised(0.2) });
  await reaches(page, 'paused', 60_000);
  await headset.place(stretched);
  await keepPicture(page, 'study-paused');
  await press(page, 'ask-to-stop');
  await reaches(page, 'stopping');
  await keepPicture(page, 'study-stopping');
  await press(page, 'stop');
  await reaches(page, 'end');
  await keepPicture(page, 'study-stopped');
  await expect.poll(async () => (await study(page)).unsent, { timeout: 40_000 }).toBe(0);

  await page.goto('/experimenter');
  await signIn(page);
  await page.getByRole('combobox', { name: 'Study' }).selectOption('stopping');
  await expect(page.getByRole('row', { name: /P01/ }).getByText('stopped')).toBeVisible();
  await keepPicture(page, 'study-experimenter-stopped');
});
