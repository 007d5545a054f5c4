import { join } from 'node:path';
import { isDeepStrictEqual } from 'node:util';
import { DatabaseSync } from '@photostructure/sqlite';
import { participantsOf, type StudyPlan } from '../../../../src/study/model/plan/plan';
import { type Schedule, scheduleFor } from '../../../../src/study/model/plan/schedule';
import type { ParticipantState } from '../../../../src/study/model/progress/study-api';
import type { StudyRecord } from '../../../../src/study/model/records/study-record';
import { openStudyStore } from '../../../../src/study/server/sqlite/study-store';
import { type RandomSource, randomSource } from '../../../../src/study/simulation/random-source';
import { experimenterToken, startServer } from '../../../server/started-server';
import { directoryWith } from '../../../temporary-directory';
import { completed, paperPlan } from '../../model/studies';
import { asSent } from '../stored-studies';

/** The result of the kills; empty lists: nothing was lost. */
export interface KillReport {
  kills: number;
  /** Kills that came while a request was under way. */
  amidRequests: number;
  acknowledged: number;
  /** Acknowledged records that a server no longer had, or had otherwise, and batches of which it had a part. */
  readonly lost: string[];
  /** Participants with records of a condition that is not theirs at this place, or two devices that held one place. */
  readonly inTwoConditions: string[];
  /** Participants with data left after an acknowledged withdrawal. */
  readonly undeleted: string[];
  /** Databases that are not sound. */
  readonly unsound: string[];
}

/** A device of a participant, which repeats each request until it is acknowledged, as the page does. */
class Device {
  readonly study: string;
  readonly participant: string;
  readonly schedule: Schedule;
  readonly acknowledged = new Map<string, StudyRecord>();
  token: string | null = null;
  code: string | null = null;
  withdrawn: 'no' | 'asked' | 'yes' = 'no';
  /** The records that are sent together until they are acknowledged. */
  batch: readonly StudyRecord[] = [];
  readonly #records: readonly StudyRecord[];
  #sent = 0;

  constructor(plan: StudyPlan, participant: string) {
    this.study = plan.id;
    this.participant = participant;
    this.schedule = scheduleFor(plan, participant);
    this.#records = completed(participant, { plan, motion: true });
  }

  get finished(): boolean {
    return this.withdrawn === 'yes' || (this.#sent >= this.#records.length && this.withdrawn === 'no');
  }

  get path(): string {
    return `/${this.study}/participants/${this.participant}`;
  }

  /** Returns the batch under way, or the next one. */
  nextBatch(random: RandomSource): readonly StudyRecord[] {
    if (this.batch.length === 0)
      this.batch = this.#records.slice(this.#sent, this.#sent + 1 + Math.floor(3 * random.uniform()));
    return this.batch;
  }

  accepted(batch: readonly StudyRecord[]): void {
    this.#sent += batch.length;
    this.batch = [];
    for (const record of batch) this.acknowledged.set(record.id, record);
  }
}

type Ask = (method: string, path: string, token: string | null, body?: unknown) => Promise<Response>;

/** Sends a device's next request; resolves with the server's answer, rejects if the server is gone. */
async function act(device: Device, ask: Ask, random: RandomSource): Promise<void> {
  const { path, participant } = device;
  if (device.withdrawn === 'asked' || (device.acknowledged.size > 8 && device.code && random.uniform() < 0.02)) {
    device.withdrawn = 'asked';
    const answer = await ask('POST', `/${device.study}/withdraw`, null, { code: device.code });
    // 404: the kill came after the deletion, and before its answer.
    if (answer.status === 200 || answer.status === 404) device.withdrawn = 'yes';
    return;
  }
  if (device.token === null) {
    const states = (await (await ask('GET', `/${device.study}/participants`, experimenterToken)).json()) as {
      participants: ParticipantState[];
    };
    const { invitation, claimed } = states.participants.find(
      (one) => one.participant === participant,
    ) as ParticipantState;
    // The answer with the token was lost, so the experimenter releases the place.
    if (claimed) await ask('POST', `${path}/release`, experimenterToken);
    // Two tabs at once.
    const claims = await Promise.all([1, 2].map(() => ask('POST', `${path}/claim`, null, { invitation })));
    const given = claims.filter(({ status }) => status === 201);
    if (given.length > 1) throw new Error(`${participant} was given to two devices`);
    const [claim] = given;
    if (!claim) return;
    const { token, withdrawalCode } = (await claim.json()) as { token: string; withdrawalCode: string | null };
    device.token = token;
    device.code ??= withdrawalCode;
    return;
  }
  const batch = device.nextBatch(random);
  const answer = await ask('POST', `${path}/records`, device.token, { records: batch });
  if (answer.status !== 200) throw new Error(`${participant}: ${answer.status} ${await answer.text()}`);
  const { acknowledged } = (await answer.json()) as { acknowledged: string[] };
  device.accepted(batch.filter(({ id }) => acknowledged.includes(id)));
}

/** Returns the acknowledged data of a device that the files of a killed server lack. */
function check(device: Device, store: ReturnType<typeof openStudyStore>, report: KillReport): void {
  const { study, participant, schedule } = device;
  const stored = store.records.all(study, participant).map(asSent);
  if (device.withdrawn === 'yes') {
    if (stored.length > 0) report.undeleted.push(`${study} ${participant}: ${stored.length} records`);
    return;
  }
  // A withdrawal without an answer deletes everything or nothing.
  if (device.withdrawn === 'asked' && stored.length === 0) return;
  if (device.token && !store.places.holds(study, participant, device.token))
    report.lost.push(`${study} ${participant}: its place`);
  const byId = new Map(stored.map((record) => [record.id, record]));
  for (const [id, sent] of device.acknowledged) {
    if (!isDeepStrictEqual(byId.get(id), sent)) report.lost.push(`${study} ${participant} ${id}`);
  }
  const whole = device.batch.every(({ id }) => byId.has(id));
  if (!whole && device.batch.some(({ id }) => byId.has(id)))
    report.lost.push(`${study} ${participant}: half of a batch`);
  for (const record of stored) {
    if (record.kind !== 'trial' || record.body.condition === null) continue;
    const { place, condition } = record.body;
    const due = schedule.steps.find(
      (step) => step.kind === 'trial' && step.task === place.task && step.block === place.block,
    );
    if (due?.kind !== 'trial' || due.condition !== condition)
      report.inTwoConditions.push(`${study} ${participant} ${record.id}`);
  }
}

const askOf =
  (url: string): Ask =>
  (method, path, token, body) =>
    fetch(`${url}/api/studies${path}`, {
      method,
      headers: { 'content-type': 'application/json', ...(token && { authorization: `Bearer ${token}` }) },
      ...(body !== undefined && { body: JSON.stringify(body) }),
    });

/** Participants at once; studies follow each other as they finish. */
const devicesAtOnce = 6;

/**
 * Kills a server of studies (SIGKILL) so often at a drawn moment while participants write, two experimenters begin the
 * same study and participants withdraw; looks into its files after each. The same seed draws the same moments; what the
 * operating system makes of them it does not.
 */
export async function killedStudy(
  kills: number,
  seed: number,
  tell: (line: string) => void = () => undefined,
): Promise<KillReport> {
  const directory = directoryWith();
  const file = join(directory, 'studies/studies.db');
  const random = randomSource(seed, 'kills');
  const report: KillReport = {
    ...{ kills: 0, amidRequests: 0, acknowledged: 0 },
    ...{ lost: [], inTwoConditions: [], undeleted: [], unsound: [] },
  };
  const everyone: Device[] = [];
  let devices: Device[] = [];
  for (let number = 0; report.kills < kills; ) {
    const server = await startServer({}, { directory });
    const ask = askOf(server.url);
    let underWay = 0;
    let answers = 0;
    const counted: Ask = async (...asked) => {
      underWay += 1;
      try {
        return await ask(...asked);
      } finally {
        underWay -= 1;
        answers += 1;
      }
    };
    if (devices.every(({ finished }) => finished)) {
      number += 1;
      const plan = paperPlan({ id: `killed-${number}` });
      // Two experimenters at once, with the same plan: both have it.
      const begun = await Promise.all([1, 2].map(() => ask('POST', '', experimenterToken, { plan, simulated: false })));
      for (const { status } of begun) if (status !== 201) throw new Error(`the study was not begun: ${status}`);
      devices = participantsOf(plan)
        .slice(0, devicesAtOnce)
        .map((one) => new Device(plan, one));
      everyone.push(...devices);
    }
    const until = Math.floor(30 * random.uniform());
    const delayMs = 4 * random.uniform();
    let dying = false;
    const faults: unknown[] = [];
    const loops = devices.map(async (device) => {
      while (!dying && !device.finished) {
        try {
          await act(device, counted, random);
        } catch (error) {
          // fetch says "TypeError" of a server that is gone, and of one that has just closed the connection because
          // nothing came by it for some seconds: then it is sent again, as the page does.
          const unanswered = error instanceof TypeError;
          if (unanswered && !dying && server.isAlive()) continue;
          if (!unanswered || !dying) faults.push(error);
          return;
        }
      }
    });
    while (answers < until && !devices.every(({ finished }) => finished) && faults.length === 0) {
      await new Promise((resolve) => setTimeout(resolve, 1));
    }
    await new Promise((resolve) => setTimeout(resolve, delayMs));
    dying = true;
    if (underWay > 0) report.amidRequests += 1;
    await server.kill();
    await Promise.all(loops);
    if (faults.length > 0) throw faults[0];
    report.kills += 1;
    const store = openStudyStore(file);
    // Old studies now and then, those at hand every time.
    for (const device of report.kills % 50 === 0 || report.kills === kills ? everyone : devices)
      check(device, store, report);
    store.close();
    const database = new DatabaseSync(file);
    const { integrity_check: sound } = database.prepare('PRAGMA integrity_check').get() as { integrity_check: string };
    database.close();
    if (sound !== 'ok') report.unsound.push(`kill ${report.kills}: ${sound}`);
    if (report.kills % 100 === 0) tell(`${report.kills} kills, ${report.amidRequests} amid requests`);
  }
  report.acknowledged = everyone.reduce((sum, { acknowledged }) => sum + acknowledged.size, 0);
  return report;
}
