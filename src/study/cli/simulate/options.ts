import { parseArgs } from 'node:util';
import { ValidationError } from 'threepoint/core/validation/validation';
import type { StudyPlan } from '../../model/plan/plan';
import type { StatedEffects } from '../../simulation/simulate-study';

/** The parsed options of the command line, which are not checked against the plan yet. */
export interface SimulateOptions {
  readonly plan: string;
  readonly out: string;
  readonly participants: number | null;
  readonly seed: number | null;
  effectsOn(plan: StudyPlan): StatedEffects;
}

function wholeNumber(name: string, given: string | undefined): number | null {
  if (given === undefined) return null;
  if (!/^\d{1,9}$/.test(given)) throw new ValidationError(`--${name}`, `expected a whole number, not "${given}"`);
  return Number(given);
}

/** Parses "late-200=-0.8"; a number alone belongs to the second condition, or else to the second cohort. */
function effectsIn(name: string, given: readonly string[], plan: StudyPlan): Readonly<Record<string, number>> {
  const { conditions, cohorts = [] } = plan;
  const usual = (conditions[1] ?? cohorts[1])?.id ?? '';
  return Object.fromEntries(
    given.map((one) => {
      const at = one.lastIndexOf('=');
      const value = one.slice(at + 1);
      if (value.trim() === '' || !Number.isFinite(Number(value))) {
        throw new ValidationError(`--${name}`, `expected a number, or a condition and one (id=0.5), not "${one}"`);
      }
      return [at < 0 ? usual : one.slice(0, at), Number(value)];
    }),
  );
}

/** Throws a ValidationError with the name of the option. */
export function simulateOptions(): SimulateOptions {
  const text = { type: 'string' } as const;
  const several = { type: 'string', multiple: true } as const;
  const { values } = parseArgs({
    options: { participants: text, out: text, seed: text, plan: text, effect: several, 'score-effect': several },
  });
  if (!values.out || !values.plan) throw new ValidationError('', 'both --out and --plan are needed');
  return {
    plan: values.plan,
    out: values.out,
    participants: wholeNumber('participants', values.participants),
    seed: wholeNumber('seed', values.seed),
    effectsOn: (plan) => ({
      answers: effectsIn('effect', values.effect ?? [], plan),
      scores: effectsIn('score-effect', values['score-effect'] ?? [], plan),
    }),
  };
}
