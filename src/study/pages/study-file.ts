import { strFromU8, unzipSync } from 'fflate';
import { reasonOf } from 'threepoint/core';
import { type StudyPlan, storedPlan } from '../model/plan/plan';
import { exportedRecord, type StoredRecord } from '../model/records/study-record';

/** A study and its records under one version of its plan, as an export contains them. */
export interface OpenedStudy {
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  readonly records: readonly StoredRecord[];
  /** The version of the plan that the records follow, if the plan has several. */
  readonly planVersion?: number;
}

/** The largest unpacked size of an export [bytes]. Exports of whole studies have a few megabytes. */
const largest = 512 * 2 ** 20;

/** Reads the zip file of an export; throws an Error that names the file in it and what is wrong. */
export function openStudyFile(zip: Uint8Array): OpenedStudy {
  let files: Record<string, Uint8Array>;
  let size = 0;
  try {
    files = unzipSync(zip, {
      filter({ name, originalSize }) {
        if (!/(^|\/)(plan|records)\.json$/.test(name)) return false;
        size += originalSize;
        return size <= largest;
      },
    });
  } catch (error) {
    throw new Error(`This is not an export of a study: ${reasonOf(error)}.`);
  }
  const json = (name: string): unknown => {
    const path = Object.keys(files).find((path) => path === name || path.endsWith(`/${name}`));
    if (!path) throw new Error(`This is not an export of a study: it has no ${name}.`);
    try {
      return JSON.parse(strFromU8(files[path] as Uint8Array));
    } catch (error) {
      throw new Error(`${path}: ${reasonOf(error)}`);
    }
  };
  const plan = storedPlan(json('plan.json'));
  const file = json('records.json');
  if (typeof file !== 'object' || file === null || !('records' in file) || !Array.isArray(file.records)) {
    throw new Error('records.json: expected a list of records');
  }
  const records = file.records.map((record: unknown, index: number) => {
    try {
      return exportedRecord(record, plan);
    } catch (error) {
      throw new Error(`records.json: records[${index}]: ${reasonOf(error)}`);
    }
  });
  // Exports of an unchanged plan name no version.
  const versionPart =
    'planVersion' in file && typeof file.planVersion === 'number' ? { planVersion: file.planVersion } : {};
  return { plan, records, simulated: 'simulated' in file && file.simulated === true, ...versionPart };
}
