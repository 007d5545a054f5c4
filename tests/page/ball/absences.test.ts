import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { cases } from '../../nightly';
import { type GroupPlan, groupPlan, rowsOf, trialProblems } from '../../study/model/group-sessions';
import { groupOfPages } from './group-of-pages';

const matchSeconds = 15;
const waitSeconds = 10;

const planWhere = (after: 'repeat' | 'end') => groupPlan(matchSeconds, { waitSeconds, after });

type Group = Awaited<ReturnType<typeof groupOfPages>>;

/** Lets time pass until all three have gone on. */
async function play(group: Group, longest = 300): Promise<void> {
  for (let passed = 0; passed < longest && !group.isOver; passed += 1) await group.pass(1);
  expect(group.isOver).toBe(true);
}

const trialRows = ({ records }: Group, plan: GroupPlan) => rowsOf(records, plan, 'trials');

describe('a match of a group in a study', () => {
  test('waits for a page that is loaded again, and counts for the others alone', async () => {
    const plan = planWhere('repeat');
    const group = await groupOfPages(plan);
    await group.pass(6);
    const page = group.pageOf(1);
    page.close();
    await group.pass(3);
    expect(group.pages.map(({ standing }) => standing)).toEqual([true, false, true]);
    expect(group.pageOf(0).awaited?.participants).toEqual([page.participant]);
    expect(group.pageOf(0).awaited?.secondsLeft).toBeCloseTo(waitSeconds - 3, 0);
    page.loadAgain();
    await group.pass(0.5);
    expect(page.awaited?.secondsLeft).toBeGreaterThan(0);
    await play(group);
    const rows = trialRows(group, plan);
    expect(rows).toHaveLength(3);
    for (const row of rows) {
      const isLate = row.participant === page.participant;
      expect(row.excluded).toMatch(isLate ? /^incomplete: recorded from second \d/ : /^$/);
      expect(row.attempt).toBe(isLate ? 2 : 1);
      expect(row.absences).toMatch(new RegExp(`^${page.participant}: 4\\.\\d s at second \\d`));
    }
    expect(new Set(rows.map(({ absences }) => absences)).size).toBe(1);
    expect(trialProblems(group.records, plan)).toEqual([]);
    const absences = rowsOf(group.records, plan, 'events').filter(({ event }) => event === 'absence');
    expect(absences.map(({ participant }) => participant)).toEqual(group.pages.map((one) => one.participant));
    expect(new Set(absences.map(({ second, seconds }) => `${second} ${seconds}`)).size).toBe(1);
  });

  test('waits for a lost network, after which all three trials count', async () => {
    const plan = planWhere('repeat');
    const group = await groupOfPages(plan);
    await group.pass(6);
    group.pageOf(2).fallSilent();
    await group.pass(8);
    expect(group.pageOf(0).standing).toBe(true);
    group.pageOf(2).comeBack();
    await play(group);
    const rows = trialRows(group, plan);
    expect(rows.map(({ excluded, attempt }) => [excluded, attempt])).toEqual([1, 2, 3].map(() => ['', 1]));
    expect(rows.every(({ absences }) => /: 5\.\d s/.test(absences))).toBe(true);
    expect(trialProblems(group.records, plan)).toEqual([]);
  });

  test('is void for all after the limit of its plan, and played again', async () => {
    const plan = planWhere('repeat');
    const group = await groupOfPages(plan);
    await group.pass(6);
    group.pageOf(0).close();
    await group.pass(waitSeconds + 5);
    expect(group.pages.map(({ attempt }) => attempt)).toEqual([1, 2, 2]);
    group.pageOf(0).loadAgain();
    await play(group);
    const rows = trialRows(group, plan);
    expect(rows.map(({ excluded, absences, attempt }) => [excluded, absences, attempt])).toEqual(
      [1, 2, 3].map(() => ['', '', 2]),
    );
    const texts = rowsOf(group.records, plan, 'events').map(({ event, text }) => `${event} ${text}`);
    expect(texts.filter((text) => text.endsWith('given up'))).toHaveLength(2);
    expect(texts.filter((text) => text.startsWith('interrupted'))).toHaveLength(3);
  });

  test('ends after the limit where the plan says so, and its trials are not counted', async () => {
    const plan = planWhere('end');
    const group = await groupOfPages(plan);
    await group.pass(6);
    group.pageOf(0).lose();
    await group.pass(waitSeconds + 6);
    expect(group.pages.map(({ isOver }) => isOver)).toEqual([false, true, true]);
    group.pageOf(0).comeBack();
    await play(group);
    for (const row of trialRows(group, plan)) {
      expect([row.ended, row.excluded]).toEqual(['absence', 'incomplete: given up, a participant was away']);
      expect(row.absences).toMatch(/given up$/);
    }
    expect(trialProblems(group.records, plan)).toEqual([]);
  });
});

interface RandomAbsence {
  readonly seat: number;
  readonly after: number;
  readonly seconds: number;
  readonly kind: 'reload' | 'silent' | 'lost';
}

const randomAbsence: fc.Arbitrary<RandomAbsence> = fc.record({
  seat: fc.integer({ min: 0, max: 2 }),
  after: fc.integer({ min: 1, max: 80 }).map((tenths) => tenths / 10),
  seconds: fc.integer({ min: 1, max: 160 }).map((tenths) => tenths / 10),
  kind: fc.constantFrom('reload', 'silent', 'lost'),
});

/** Plays a match with these absences, one after another or overlapping. */
async function playWith(plan: GroupPlan, absences: readonly RandomAbsence[]): Promise<Group> {
  const group = await groupOfPages(plan);
  await group.pass(2);
  const due: { readonly at: number; readonly seat: number; readonly kind: RandomAbsence['kind'] }[] = [];
  const away = new Set<number>();
  const returnOf = async (until: number) => {
    for (const one of due.toSorted((a, b) => a.at - b.at)) {
      if (one.at > until) continue;
      await group.pass(Math.max(0, one.at - group.room.time));
      const page = group.pageOf(one.seat);
      if (one.kind === 'reload') page.loadAgain();
      else page.comeBack();
      away.delete(one.seat);
      due.splice(due.indexOf(one), 1);
    }
  };
  for (const { seat, after, seconds, kind } of absences) {
    const at = group.room.time + after;
    await returnOf(at);
    await group.pass(Math.max(0, at - group.room.time));
    const page = group.pageOf(seat);
    if (away.has(seat) || page.isOver) continue;
    away.add(seat);
    if (kind === 'reload') page.close();
    else if (kind === 'lost') page.lose();
    else page.fallSilent();
    due.push({ at: group.room.time + seconds, seat, kind });
  }
  await returnOf(Number.POSITIVE_INFINITY);
  await play(group);
  return group;
}

test('random absences of three leave rows that state what was played and what was not', {
  tags: ['full'],
}, async () => {
  const property = fc.asyncProperty(fc.array(randomAbsence, { minLength: 1, maxLength: 4 }), async (absences) => {
    const plan = planWhere('repeat');
    const group = await playWith(plan, absences);
    const rows = trialRows(group, plan);
    const missed = rowsOf(group.records, plan, 'events').filter(({ event }) => event === 'missed');
    // Each page leaves one row of the match that was played to its end, unless it was away then.
    expect([...rows, ...missed].map(({ participant }) => participant).toSorted()).toEqual(['P01', 'P02', 'P03']);
    expect(new Set(rows.map((row) => row.absences)).size).toBe(1);
    expect(trialProblems(group.records, plan)).toEqual([]);
    const events = rowsOf(group.records, plan, 'events').filter(({ event }) => event === 'absence');
    for (const { participant } of rows) {
      const own = events.filter((row) => row.participant === participant);
      expect(new Set(own.map(({ text }) => text)).size).toBe(own.length);
    }
    for (const row of rows) {
      for (const text of row.absences.split('; ').filter(Boolean)) {
        expect(events.some((event) => event.participant === row.participant && event.text === text)).toBe(true);
      }
      const [seconds, absent, from] = [Number(row.seconds), Number(row.absent_seconds), Number(row.from ?? 0)];
      // What was played and what was waited make up the time on the wall.
      expect(from + seconds + absent).toBeGreaterThan((group.wallSeconds ?? 0) - 1);
      expect(from + seconds + absent).toBeLessThan((group.wallSeconds ?? 0) + 1);
      expect(row.excluded === '').toBe(row.from === null);
      if (row.excluded === '') expect(seconds).toBeGreaterThan(matchSeconds - 1);
    }
  });
  await fc.assert(property, { numRuns: cases(15) });
});
