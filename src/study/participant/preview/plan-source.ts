import { type FileKind, nameOf, readLimited } from 'threepoint-ui/limited-files';
import { parsePlan, planComplaints, type StudyPlan } from '../../model/plan/plan';

/** A plan, or everything that is wrong with its file, each with file, field and reason. */
export type ReadPlan =
  | { readonly name: string; readonly plan: StudyPlan }
  | { readonly name: string; readonly complaints: readonly string[] };

const planFile: FileKind = { what: 'a study file', megabytes: 1 };

/** Returns the plan in the text of a file. */
export function planFrom(json: string, name: string): ReadPlan {
  const complaints = planComplaints(json, name);
  return complaints.length > 0 ? { name, complaints } : { name, plan: parsePlan(json, name) };
}

/** Resolves with the plan at an address or in a file; rejects with a sentence if it cannot be read. */
export async function readPlan(source: string | File): Promise<ReadPlan> {
  const bytes = await readLimited(source, planFile);
  return planFrom(new TextDecoder().decode(bytes), nameOf(source));
}
