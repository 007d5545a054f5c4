import { checkedPlan, type StudyPlan } from '../../model/plan/plan';
import { simulatedPlan } from '../../simulation/simulate-study';

/**
 * Returns the plan of a study file, renamed if it is simulated. Throws an Error with a sentence for the experimenter.
 */
export function planToBegin(json: string, simulated: boolean): StudyPlan {
  const plan = checkedPlan(JSON.parse(json));
  return simulated ? simulatedPlan(plan) : plan;
}
