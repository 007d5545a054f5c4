import { spawnSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { strFromU8, unzipSync } from 'fflate';
import { describe, expect, test } from 'vitest';
import { groupsOf } from '../../../src/study/model/plan/allocation';
import { checkedRecord } from '../../../src/study/model/records/study-record';
import { answersIn, trialsIn } from '../../../src/study/model/tables/study-tables';
import { randomSource } from '../../../src/study/simulation/random-source';
import { noEffects, simulatedPlan } from '../../../src/study/simulation/simulate-study';
import { directoryWith } from '../../temporary-directory';
import { compareAnswers, compareScores } from '../model/answered';
import { latencyPlan, paperPlan, simulatedRecords } from '../model/studies';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const plan = simulatedPlan(paperPlan());

describe('a simulated study', () => {
  const simulated = simulatedRecords(plan);

  test('is the same for the same seed, and another for another', { tags: ['full'] }, () => {
    expect(simulatedRecords(plan)).toEqual(simulated);
    expect(simulatedRecords(plan, noEffects, 2)).not.toEqual(simulated);
  });

  test('is marked in every record and by its name', () => {
    expect(plan.id).toBe('paper-simulated');
    expect(plan.title).toMatch(/^SIMULATED: /);
    for (const record of simulated) {
      expect(record.simulated).toBe(true);
      expect(record.study).toBe('paper-simulated');
    }
  });

  test('holds what the store takes from people: complete answers, trials within their limits', () => {
    const records = simulated;
    for (const record of records) expect(checkedRecord(JSON.parse(JSON.stringify(record)), plan)).toEqual(record);
    const valid = trialsIn(records).filter(({ excluded }) => !excluded);
    expect(valid).toHaveLength(15 * 4);
    expect(answersIn(records, plan).filter(({ excluded }) => !excluded)).toHaveLength(15 * 24);
    for (const { score, maximum } of valid) expect(score).toBeLessThanOrEqual(maximum);
  });

  test('retries what was interrupted and discounts what was voided, as people do', { tags: ['full'] }, () => {
    const records = simulatedRecords({ ...plan, participants: 60 });
    const types = new Set(records.flatMap((record) => (record.kind === 'event' ? [record.body.type] : [])));
    expect([...types].toSorted()).toEqual(['finished', 'interrupted', 'void-block']);
    const trials = trialsIn(records);
    expect(trials.filter(({ excluded }) => excluded.startsWith('voided')).length).toBeGreaterThan(0);
    expect(trials.filter(({ excluded }) => !excluded)).toHaveLength(60 * 4);
  });

  test('gives a group of three one score, with at most twenty throws together', () => {
    const ball = simulated.flatMap((record) =>
      record.kind === 'trial' && record.body.place.task === 'ball' ? [record] : [],
    );
    for (const members of groupsOf(plan, 3)) {
      for (const block of [1, 2]) {
        const trials = ball.filter(
          ({ participant, body }) => members.includes(participant) && body.place.block === block && body.condition,
        );
        expect(trials).toHaveLength(3);
        expect(new Set(trials.map(({ body }) => body.outcome.score)).size).toBe(1);
        expect(trials.reduce((sum, { body }) => sum + body.outcome.shots, 0)).toBeLessThanOrEqual(20);
        expect(trials.reduce((sum, { body }) => sum + body.outcome.hits, 0)).toBe(trials[0]?.body.outcome.score);
      }
    }
  });

  test('shows the analysis what was put in: answers and scores', () => {
    const records = simulatedRecords(plan, { answers: { paper: 1.5 }, scores: { ik: -0.5 } });
    const answers = compareAnswers(answersIn(records, plan));
    expect(answers.comparisons.filter(({ holmP }) => (holmP ?? 1) < 0.05).length).toBeGreaterThan(6);
    const [archery] = compareScores(trialsIn(records)).points.comparisons;
    expect(archery?.test?.t).toBeGreaterThan(0);
    expect(archery?.test?.p).toBeLessThan(0.05);
  });
});

test('the source of chance is standard normal', () => {
  const random = randomSource(3, 'normal');
  const drawn = Array.from({ length: 20_000 }, () => random.normal());
  const mean = drawn.reduce((sum, value) => sum + value, 0) / drawn.length;
  const variance = drawn.reduce((sum, value) => sum + (value - mean) ** 2, 0) / drawn.length;
  expect(Math.abs(mean)).toBeLessThan(0.03);
  expect(Math.abs(variance - 1)).toBeLessThan(0.05);
});

describe('npm run tool -- study:simulate', () => {
  const simulateInto = (out: string, ...args: string[]) =>
    spawnSync(process.execPath, ['scripts/tool.mjs', 'study:simulate', '--out', out, ...args], {
      cwd: root,
      encoding: 'utf8',
    });

  test('writes exports that say SIMULATED, and reads back as one study', { tags: ['full'] }, () => {
    const out = join(directoryWith(), 'new');
    const { status, stdout, stderr } = simulateInto(out, '--participants', '6');
    expect(stderr).toBe('');
    expect(status).toBe(0);
    expect(stdout).toContain('SIMULATED study of 6 participants');
    expect(readdirSync(out).toSorted()).toEqual([
      'SIMULATED-effects.json',
      'SIMULATED-paper-simulated',
      'SIMULATED-paper-simulated.zip',
      'SIMULATED-studies.db',
      'participants',
    ]);
    const zip = unzipSync(readFileSync(join(out, 'SIMULATED-paper-simulated.zip')));
    for (const [path, bytes] of Object.entries(zip)) {
      expect(readFileSync(join(out, path), 'utf8')).toBe(strFromU8(bytes));
    }
    expect(readdirSync(join(out, 'participants'))).toHaveLength(6);
    expect(simulateInto(out).stderr).toContain('is not empty');
  });

  test('simulates any plan with the effects that are stated: between cohorts, three conditions, several questionnaires', {
    tags: ['full'],
  }, () => {
    const mixed = latencyPlan({
      cohorts: [
        { id: 'own-size', label: 'Adult', avatar: 'woman' },
        { id: 'small', label: 'Child', avatar: 'child' },
      ],
    });
    const directory = directoryWith({ 'mixed.json': JSON.stringify(mixed) });
    const out = join(directory, 'out');
    const effects = ['--effect', 'late-200=-1.5', '--effect', 'small=1', '--score-effect', 'late-200=-0.2'];
    const { status, stdout, stderr } = simulateInto(
      out,
      join(directory, 'mixed.json'),
      '--seed',
      '4',
      '--participants',
      '24',
      ...effects,
    );
    expect(stderr).toBe('');
    expect(status).toBe(0);
    expect(stdout).toContain(
      'answers −1.5 points under "late-200"; answers +1 points under "small"; chances to hit −0.2 under "late-200".',
    );
    expect(JSON.parse(readFileSync(join(out, 'SIMULATED-effects.json'), 'utf8'))).toEqual({
      simulated: true,
      seed: 4,
      effects: { answers: { 'late-200': -1.5, small: 1 }, scores: { 'late-200': -0.2 } },
    });
  });

  test.each<[string[], string]>([
    [['--effect', 'sideways=1'], 'there is no condition or cohort "sideways"'],
    [['--effect', 'paper=much'], '--effect: expected a number'],
    [['--participants', '16'], 'cannot be divided into groups of 3'],
    [['--participants', 'many'], '--participants: expected a whole number'],
    [['--plan', 'none.json'], 'there is no file'],
    [['--speed', '9'], '--speed'],
  ])('with %j says what is wrong', { tags: ['full'] }, (args, message) => {
    const { status, stderr } = simulateInto(join(directoryWith(), 'new'), ...args);
    expect(status).toBe(1);
    expect(stderr).toContain(message);
    expect(stderr).not.toContain('    at ');
  });
});
