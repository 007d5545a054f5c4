import { join } from 'node:path';
import { createRouter, noPage } from 'threepoint-http';
import { onTestFinished } from 'vitest';
import { createExperimenterClient } from '../../../src/study/client/study-client';
import type { StudyPlan } from '../../../src/study/model/plan/plan';
import type { StudyRecord } from '../../../src/study/model/records/study-record';
import { openStudyStore } from '../../../src/study/server/sqlite/study-store';
import { serve } from '../../http/serve';
import { directoryWith } from '../../temporary-directory';
import { paperPlan } from '../model/studies';
import { experimenter, studiesInThisThread } from '../server/running-studies';

/** The place of the first participant of the paper's study. */
export const place = { study: 'paper', participant: 'P01' } as const;

/** The contents of records by kind. */
type Bodies = { readonly [One in StudyRecord as One['kind']]: One['body'] };

/**
 * The real server with the paper's study, changed or not, on a port; it can be taken away and put back on the same
 * port.
 */
export async function studyServer(changes: Partial<StudyPlan> = {}) {
  const file = join(directoryWith(), 'studies.db');
  const store = openStudyStore(file);
  const plan = paperPlan(changes);
  store.plans.add(plan, { simulated: false, at: 1e9 });
  const routes = studiesInThisThread({ store, file, trustProxy: false, now: () => 1e9 });
  const listen = (port: number) => serve(createRouter([routes], noPage), { port });
  let server: Awaited<ReturnType<typeof serve>> | null = await listen(0);
  const { port } = server;
  const stop = async () => {
    await server?.close();
    server = null;
  };
  onTestFinished(async () => {
    await stop();
    store.close();
  });
  const origin = `http://127.0.0.1:${port}`;
  return {
    origin,
    plan,
    store,
    experimenter: createExperimenterClient(experimenter, origin),
    /** What the link of P01 says. */
    invitation: store.overview(plan.id, 1e9)[0]?.invitation as string,
    stop,
    /** Returns the contents of the stored records of a kind. */
    bodies: <Kind extends keyof Bodies>(kind: Kind): readonly Bodies[Kind][] =>
      store.records.all(plan.id).flatMap((record) => (record.kind === kind ? [record.body as Bodies[Kind]] : [])),
    /** Returns the types of the stored events. */
    events: () => store.records.all(plan.id).flatMap((record) => (record.kind === 'event' ? [record.body.type] : [])),
    async restart() {
      server = await listen(port);
    },
  };
}

export type StudyServer = Awaited<ReturnType<typeof studyServer>>;
