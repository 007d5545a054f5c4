import { checkedPlan, type StudyPlan } from '../model/plan/plan';
import { simulatedPlan } from '../simulation/simulate-study';

/** The plan in the text of a study's file, as it is begun; of a simulated one under a name that says so. Throws a sentence. */
export function planToBegin(json: string, simulated: boolean): StudyPlan {
  const plan = checkedPlan(JSON.parse(json));
  return simulated ? simulatedPlan(plan) : plan;
}
