import type { PlanVersion, StudyInfo } from '../../model/progress/study-api';
import { unpacked } from '../sqlite/study-motion';
import { openStudyStore, type StudyStore } from '../sqlite/study-store';
import { type ExportContent, exportZip } from './export-zip';
import type { ExportOrder } from './exporter';

// A process that reads the content of an export from the database and writes it to its output as a zip file. Its
// arguments are the database and the order.

/** Returns the rows of participants who follow the version of the plan that `info` shows. */
const ofVersion = <Row extends { readonly participant: string }>(rows: readonly Row[], info: StudyInfo) => {
  const { participants } = info.versions.find(({ version }) => version === info.version) as PlanVersion;
  return rows.filter(({ participant }) => participants.includes(participant));
};

function contentOf(store: StudyStore, { at, study, version, participant, software }: ExportOrder): ExportContent {
  const info = store.plans.get(study, version);
  const { simulated, createdAt, retentionUntil, versions } = info;
  const about = {
    ...{ simulated, at, retentionUntil },
    software: { exportedBy: software, served: store.software.since(createdAt) },
  };
  const records = store.records.all(study, participant);
  const motion = store.motion.all(study, participant);
  if (participant !== undefined) {
    const plan = store.plans.planFor(study, participant);
    return { ...about, plan, records, motion: motion.map(unpacked) };
  }
  return {
    ...{ ...about, plan: info.plan },
    ...(versions.length > 1 && { planVersion: info.version }),
    records: ofVersion(records, info),
    motion: ofVersion(motion, info).map(unpacked),
  };
}

const [file, order] = process.argv.slice(-2) as [string, string];
const store = openStudyStore(file, { readOnly: true });
const asked = JSON.parse(order) as ExportOrder;
const content = store.snapshot(() => contentOf(store, asked));
store.close();
process.stdout.write(exportZip(content, asked.participant));
