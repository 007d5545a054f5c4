import {
  largestGroup,
  participantsOf,
  type StudyCohort,
  type StudyCondition,
  type StudyPlan,
  type StudyTask,
} from './plan';
import { randomFor, shuffle } from './shuffle';

function permutations<T>(items: readonly T[]): readonly (readonly T[])[] {
  if (items.length < 2) return [items];
  return items.flatMap((first, index) =>
    permutations(items.filter((_, other) => other !== index)).map((rest) => [first, ...rest]),
  );
}

/**
 * Returns the orders of a Latin square of Williams (Australian Journal of Scientific Research 2, 1949): each item is at
 * each place equally often, and directly after each other equally often. An odd number needs the mirrored square too.
 */
function williams<T>(items: readonly T[]): readonly (readonly T[])[] {
  const count = items.length;
  if (count < 2) return [items];
  const first = Array.from({ length: count }, (_, place) =>
    place % 2 === 0 ? (count - place / 2) % count : (place + 1) / 2,
  );
  const rows = items.map((_, shift) => first.map((index) => items[(index + shift) % count] as T));
  return count % 2 === 0 ? rows : [...rows, ...rows.map((row) => row.toReversed())];
}

/** Returns the orders of conditions to which participants and groups are allocated. */
export function ordersOf(plan: Pick<StudyPlan, 'orders' | 'conditions'>): readonly (readonly StudyCondition[])[] {
  return plan.orders === 'all' ? permutations(plan.conditions) : williams(plan.conditions);
}

/** Draws items in blocks, each with every item once in random order, so that counts differ by one at most. */
function drawnInBlocks<T>(items: readonly T[], count: number, { seed }: StudyPlan, purpose: string): readonly T[] {
  const drawn: T[] = [];
  let random = randomFor(seed, purpose);
  while (drawn.length < count) {
    const block = shuffle(items, random);
    random = block.random;
    drawn.push(...block.items);
  }
  return drawn.slice(0, count);
}

/**
 * Returns the groups of a task, drawn from the seed and equal for all tasks of the same size; tasks for one have groups
 * of one.
 */
export function groupsOf(plan: StudyPlan, groupSize: number): readonly (readonly string[])[] {
  const participants = participantsOf(plan);
  if (groupSize === 1) return participants.map((participant) => [participant]);
  const drawn = shuffle(participants, randomFor(plan.seed, `groups of ${groupSize}`)).items;
  return Array.from({ length: drawn.length / groupSize }, (_, index) =>
    drawn.slice(index * groupSize, (index + 1) * groupSize).toSorted(),
  );
}

/** Returns the participant and everyone who plays with them in a task, directly or through others. */
export function togetherWith(plan: StudyPlan, participant: string): ReadonlySet<string> {
  const groups = [...new Set(plan.tasks.map(({ groupSize }) => groupSize))].flatMap((size) => groupsOf(plan, size));
  const met = new Set([participant]);
  // The iteration over a set includes members that are added during it.
  for (const member of met) {
    for (const group of groups) if (group.includes(member)) for (const other of group) met.add(other);
  }
  return met;
}

/** Returns the cohort of every participant, equal in a group; empty: the plan has none. */
export function cohortsByParticipant(plan: StudyPlan): ReadonlyMap<string, StudyCohort> {
  const { cohorts = [] } = plan;
  if (cohorts.length === 0) return new Map();
  const groups = groupsOf(plan, largestGroup(plan));
  const drawn = drawnInBlocks(cohorts, groups.length, plan, 'cohorts');
  return new Map(groups.flatMap((members, index) => members.map((member) => [member, drawn[index] as StudyCohort])));
}

/** Returns the order of conditions for each group of a task, drawn in blocks and separately in each cohort. */
export function ordersByGroup(plan: StudyPlan, task: StudyTask): readonly (readonly StudyCondition[])[] {
  const orders = ordersOf(plan);
  const groups = groupsOf(plan, task.groupSize);
  if (!plan.cohorts) return drawnInBlocks(orders, groups.length, plan, `orders of ${task.id}`);
  const cohorts = cohortsByParticipant(plan);
  const drawn = new Map(
    plan.cohorts.map(({ id }) => [
      id,
      [...drawnInBlocks(orders, groups.length, plan, `orders of ${task.id} in ${id}`)],
    ]),
  );
  return groups.map(([member = '']) => {
    const { id } = cohorts.get(member) as StudyCohort;
    return drawn.get(id)?.shift() as readonly StudyCondition[];
  });
}
