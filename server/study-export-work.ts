import { parentPort, workerData } from 'node:worker_threads';
import type { PlanVersion, StudyInfo } from '../src/core/study/study-api';
import { type ExportContent, exportZip } from './study-export';
import type { ExportOrder } from './study-export-thread';
import { unpacked } from './study-motion';
import { openStudyStore, type StudyStore } from './study-store';

// The work of one thread: an export from what is stored, sent back as the bytes of its zip.

/** What was recorded of participants who follow the version of the plan that `info` shows. */
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

const { file, order } = workerData as { readonly file: string; readonly order: ExportOrder };
const store = openStudyStore(file, { readOnly: true });
const content = store.snapshot(() => contentOf(store, order));
store.close();
const zip = exportZip(content, order.participant);
parentPort?.postMessage(zip, [zip.buffer as ArrayBuffer]);
