import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { planJsonSchema } from '../../../src/study/cli/check/plan-json-schema';
import { shippedPhrases } from '../../../src/study/model/phrases/phrases';
import { checkedPlan, type StudyTask } from '../../../src/study/model/plan/plan';
import { durationOf, outlineOf } from '../../../src/study/model/plan/plan-outline';
import { orderCounts } from '../../../src/study/model/plan/plan-remarks';
import { directoryWith } from '../../temporary-directory';
import { examplePlan, paperFile, paperPlan, planComplaints } from '../model/studies';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const read = (path: string) => readFileSync(join(root, path), 'utf8');

describe('the schema for editors', () => {
  test('is made from the schema by which the program reads plans (npx tsx src/study/cli/build-study-schema.ts)', () => {
    expect(JSON.parse(read('public/studies/plan.schema.json'))).toEqual(JSON.parse(JSON.stringify(planJsonSchema())));
  });

  test('stands beside what the page says to participants, to be translated', () => {
    expect(JSON.parse(read('public/studies/phrases.json'))).toEqual(JSON.parse(JSON.stringify(shippedPhrases)));
  });

  test('knows every field of the shipped plans, and that there are no others', () => {
    const { properties, additionalProperties, required } = planJsonSchema() as {
      properties: Record<string, unknown>;
      additionalProperties: boolean;
      required: string[];
    };
    for (const file of ['public/studies/paper.json', 'public/studies/example.json']) {
      const plan = JSON.parse(read(file)) as object;
      expect(Object.keys(properties)).toEqual(expect.arrayContaining(Object.keys(plan)));
      expect(Object.keys(plan)).toEqual(expect.arrayContaining(required));
    }
    expect(additionalProperties).toBe(false);
  });
});

describe('the list of faults in a plan', () => {
  test('is empty for the shipped ones', () => {
    for (const name of ['paper', 'example']) {
      expect(planComplaints(read(`public/studies/${name}.json`), `${name}.json`)).toEqual([]);
    }
  });

  test('is complete at once, each fault with file, field and reason', () => {
    const wrong = JSON.parse(paperFile);
    wrong.seed = 'seven';
    wrong.conditions[1].estimator = 'magic';
    delete wrong.tasks[0].title;
    expect(planComplaints(JSON.stringify(wrong), 'mine.json')).toEqual([
      'mine.json: seed: expected a whole number from 0 to 2147483647',
      expect.stringContaining('mine.json: conditions[1].estimator: expected one of hands-only'),
      'mine.json: tasks[0].title: is missing',
    ]);
  });

  test('has what its parts demand of each other, once each is right', () => {
    expect(planComplaints(JSON.stringify({ ...paperPlan(), participants: 16 }), 'mine.json')).toEqual([
      'mine.json: tasks[1].groupSize: 16 participants cannot be divided into groups of 3',
    ]);
    expect(planComplaints('{', 'mine.json')[0]).toContain('mine.json: this is not JSON');
  });
});

describe('the summary of a plan', () => {
  test('gives the time of its rounds, rests and questionnaires', () => {
    // Archery: practice 70, two rounds of 70; ball: practice 90 and its rest, two rounds of 90. Four rests, four
    // questionnaires.
    expect(durationOf(paperPlan())).toEqual({ played: 480, rests: 300, questionnaires: 1680 });
  });

  test('has every screen in order, every question among them', () => {
    const screens = outlineOf(examplePlan(), 'P01');
    expect(screens[0]?.shows).toBe('Consent: Taking part');
    expect(screens.filter(({ at, shows }) => at === 'either' && / of 6, /.test(shows))).toHaveLength(2 * 12);
    expect(screens.at(-1)?.shows).toBe('Thank you');
  });

  test('says how often each order comes, also one that never does', () => {
    const [task] = paperPlan().tasks as [StudyTask];
    expect([...orderCounts(paperPlan(), task).values()].toSorted()).toEqual([7, 8]);
    const few = checkedPlan({ ...examplePlan(), participants: 1 });
    expect([...orderCounts(few, few.tasks[0] as StudyTask).values()].toSorted()).toEqual([0, 1]);
  });
});

describe('npm run tool -- study:check', () => {
  const check = (...args: readonly string[]) =>
    spawnSync(process.execPath, ['scripts/tool.mjs', 'study:check', ...args], { cwd: root, encoding: 'utf8' });

  test('says what a participant sees and how long it takes, and that orders are not balanced', () => {
    const { status, stdout } = check('public/studies/paper.json', '--participant', 'P02');
    expect(stdout).toContain('A participant takes at most 41:00 min');
    expect(stdout).toContain('orders are not balanced');
    expect(stdout).toContain('What P02 sees:');
    expect(stdout).toContain('1 of 7, Q1 (likert 1 to 5)');
    expect(status).toBe(0);
  });

  test('names those without a neighbour and those who may stop, and where they meet this', { tags: ['full'] }, () => {
    const file = join(directoryWith(), 'mine.json');
    const remote = { contact: 'Call 555 0100.', freeSpace: 2.5 };
    const askToStop = [
      { questionnaire: 'archery', measure: 'Q2', atLeast: 4 },
      { questionnaire: 'archery', measure: 'Q3', atLeast: 5 },
    ];
    writeFileSync(file, JSON.stringify({ ...paperPlan(), remote, askToStop }));
    const { status, stdout } = check(file);
    expect(stdout).toContain('(remote): device, 2.5 m of room and height are checked. They read: Call 555 0100.');
    expect(stdout).toContain('(askToStop): participants with "Q2" of "archery" from 4 on.');
    expect(stdout).toContain('(askToStop): participants with "Q3" of "archery" from 5 on.');
    const screens = stdout.slice(stdout.indexOf('What P01 sees:'));
    expect(screens).toMatch(
      /what is wrong with device, room \(2\.5 m\) or height, if anything\n.*measures of the body/,
    );
    expect(screens).toMatch(/7 of 7, .*\n.*How are you\? Go on, or stop: for "Q2" from 4 on or "Q3" from 5 on\n/);
    // After both rounds of archery; the ball game's questionnaire has no such measure.
    expect(screens.match(/How are you\?/g)).toHaveLength(2);
    expect(status).toBe(0);
    const { stdout: plain } = check('public/studies/paper.json');
    expect(plain).not.toMatch(/remote|askToStop|How are you|what is wrong/);
  });

  test('names the mistakes and fails', () => {
    const file = join(directoryWith(), 'mine.json');
    writeFileSync(file, JSON.stringify({ ...paperPlan(), participants: 0, seed: -1 }));
    const { status, stderr } = check(file);
    expect(stderr).toContain(`${file}: seed: expected a whole number`);
    expect(stderr).toContain(`${file}: participants: expected a whole number`);
    expect(stderr).toContain('2 mistakes in');
    expect(status).toBe(1);
  });

  test('says that a file or a participant is not there', { tags: ['full'] }, () => {
    expect(check('nowhere.json').stderr).toContain('there is no file');
    expect(check('public/studies/paper.json', '--participant', 'P99').stderr).toContain('P01 to P15, not P99');
    expect(check().stderr).toContain('one plan is needed');
  });
});
