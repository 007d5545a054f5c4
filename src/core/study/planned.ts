import { holm } from '../statistics/holm';
import type { OverallComparison } from './compare-all';
import type { Comparison } from './compare-conditions';
import type { StudyPlan } from './plan';

type Measured = Pick<Comparison, 'of' | 'asked'> & { readonly unit?: Comparison['unit'] };

/** Whether the plan names what is compared; scores are planned in points. */
export function isPlanned({ of, asked, unit }: Measured, { planned = [] }: Pick<StudyPlan, 'planned'>): boolean {
  const measure = asked ? `${asked.task}/${asked.questionnaire}/${asked.question}` : `${of}/score`;
  return unit !== 'percent' && planned.includes(measure);
}

/** The planned ones of these comparisons, adjusted by Holm as a family of their own. */
export function plannedFamily(comparisons: readonly Comparison[], plan: StudyPlan): readonly Comparison[] {
  const family = comparisons.filter((one) => isPlanned(one, plan));
  const holmP = holm(family.map(({ test }) => test?.p ?? null));
  const signedRankHolmP = holm(family.map(({ signedRank }) => signedRank?.p ?? null));
  return family.map((one, index) => ({
    ...one,
    holmP: holmP[index] ?? null,
    signedRankHolmP: signedRankHolmP[index] ?? null,
  }));
}

/** The same of analyses of all conditions and cohorts at once. */
export function plannedAnalyses(all: readonly OverallComparison[], plan: StudyPlan): readonly OverallComparison[] {
  const family = all.filter((one) => isPlanned(one, plan));
  const tested = ({ variance }: OverallComparison) => {
    const effect = variance?.within ?? variance?.between ?? null;
    return effect?.correctedP ?? effect?.p ?? null;
  };
  const holmP = holm(family.map(tested));
  const ranksHolmP = holm(family.map(({ ranks }) => ranks?.p ?? null));
  return family.map((one, index) => ({ ...one, holmP: holmP[index] ?? null, ranksHolmP: ranksHolmP[index] ?? null }));
}
