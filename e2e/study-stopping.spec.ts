import { enterVr, expect, keepPicture } from './page-fixture';
import {
  agreeAndTell,
  calibrate,
  press,
  reaches,
  signIn,
  stretched,
  study,
  takePart,
  tenHertz,
  test,
} from './study-participant';
import { experimenter, shortStudy } from './study-server';

test('a participant with no one beside them is checked, stops in the middle of a round by raising both hands, and the experimenter sees it @full', async ({
  page,
  origin,
}) => {
  test.setTimeout(180_000);
  const remote = { contact: 'Write to lab@example.org, or call 555 0100.', freeSpace: 2 };
  const plan = shortStudy('stopping');
  const tasks = plan.tasks.map((task) => ({
    ...task,
    trialSeconds: 60,
    tutorial: { ...task.tutorial, when: 'never' as const },
  }));
  await experimenter(origin).begin({ ...plan, tasks, remote }, false);
  const headset = await takePart(page, origin, 'stopping', 'P01');
  await agreeAndTell(page);
  await enterVr(page, tenHertz);
  await headset.place({ ...stretched, head: { ...stretched.head, position: [0, 0.9, 0] } });
  await reaches(page, 'calibration');
  await headset.place(stretched);
  await calibrate(page);
  await keepPicture(page, 'study-ready-to-stop');
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
