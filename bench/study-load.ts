// npm run tool -- bench:study: remote participants of one study at once on one server process, each as the page
// behaves.

import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { parsePlan, participantsOf, type StudyPlan } from '../src/study/model/plan/plan';
import { scheduleFor } from '../src/study/model/plan/schedule';
import { begin } from '../src/study/model/progress/progress';
import type { ParticipantState } from '../src/study/model/progress/study-api';
import { recordVersion, type StudyRecord } from '../src/study/model/records/study-record';
import { randomSource } from '../src/study/simulation/random-source';
import { quantile } from '../src/threepoint/core/math/statistics';
import provideBuiltServer from '../tests/server/built-server';
import { experimenterToken, startServer } from '../tests/server/started-server';
import { paperFile } from '../tests/study/model/studies';
import { playedRound } from '../tests/study/participant/played-round';

/** The interval at which the page polls for commands and sends new records [s]. */
const exchangeSeconds = 2;
/** Something is recorded about so often: an answer handed in, a pause, a trial [s]. */
const recordSeconds = 10;
/** A round with its recording ends about so often [s]. */
const roundSeconds = 60;

const options = JSON.parse(process.argv[2] ?? '{}') as Partial<
  Record<'participants' | 'seconds' | 'flush-ms' | 'json', string>
>;
const count = Number(options.participants ?? 200);
const seconds = Number(options.seconds ?? 60);
/**
 * By how much flushes of the server's disk are delayed [ms], by strace, which must be installed: those of virtual disks
 * may cost nothing.
 */
const flushMs = Number(options['flush-ms'] ?? 0);

type Times = Map<string, number[]>;

function remotePlan(): StudyPlan {
  const { hypotheses: _, ...paper } = parsePlan(paperFile, 'paper.json');
  const tasks = paper.tasks.filter(({ groupSize }) => groupSize === 1);
  return { ...paper, id: 'remote', participants: count, tasks };
}

/**
 * Requests on a connection that was closed while they were on their way: sent again, as the page does with its next
 * exchange.
 */
let sentAgain = 0;

async function answered(address: string, request: RequestInit): Promise<Response> {
  for (;;) {
    try {
      return await fetch(address, request);
    } catch (error) {
      if (!(error instanceof TypeError) || sentAgain > 10_000) throw error;
      sentAgain += 1;
    }
  }
}

/** How long a request took, by what it asked for; what is refused is counted apart. */
function client(origin: string, times: Times, refused: string[]) {
  return async (kind: string, method: string, path: string, token: string, body?: string) => {
    const start = performance.now();
    const response = await answered(`${origin}/api/studies${path}`, {
      method,
      headers: { 'content-type': 'application/json', authorization: `Bearer ${token}` },
      ...(body !== undefined && { body }),
    });
    const text = await response.text();
    const known = times.get(kind) ?? [];
    known.push(performance.now() - start);
    times.set(kind, known);
    if (!response.ok) refused.push(`${kind}: ${response.status} ${text}`);
    return text === '' ? null : JSON.parse(text);
  };
}

/** The tracked frames of a round, as every participant sends them. */
const { recording } = playedRound({}, 10);

const pause = (s: number) => new Promise((resolve) => setTimeout(resolve, 1000 * s));

/** One participant from the claim to the end of the load; returns the ids that were acknowledged. */
async function takePart(
  ask: ReturnType<typeof client>,
  plan: StudyPlan,
  { participant, invitation }: ParticipantState,
  until: number,
): Promise<number> {
  const random = randomSource(1, participant);
  const own = `/${plan.id}/participants/${participant}`;
  await pause(exchangeSeconds * random.uniform());
  const { token } = await ask('claim', 'POST', `${own}/claim`, experimenterToken, JSON.stringify({ invitation }));
  const envelope = { version: recordVersion, study: plan.id, participant, simulated: false } as const;
  const consent: StudyRecord = {
    ...{ ...envelope, at: 1e9, kind: 'consent', id: 'consent' },
    body: { version: plan.consent.version, given: true, motion: true, at: 1e9 },
  };
  let acknowledged = 0;
  const send = async (record: StudyRecord) => {
    const answer = await ask('records', 'POST', `${own}/records`, token, JSON.stringify({ records: [record] }));
    acknowledged += answer?.acknowledged?.length ?? 0;
  };
  await send(consent);
  const progress = { ...begin(scheduleFor(plan, participant)), motion: true };
  for (let number = 1; performance.now() < until; number++) {
    if (random.uniform() < exchangeSeconds / recordSeconds) {
      const text = 'an answer handed in '.repeat(20);
      await send({ ...envelope, at: number, kind: 'event', id: `event-${number}`, body: { type: 'remark', text } });
      await ask('progress', 'PUT', `${own}/progress`, token, JSON.stringify({ ...progress, events: number }));
    }
    if (random.uniform() < exchangeSeconds / roundSeconds) {
      const trial = `archery/1/trial-1@1.${number}:trial`;
      await ask('motion', 'PUT', `${own}/motion?trial=${encodeURIComponent(trial)}`, token, recording as string);
    }
    await ask('commands', 'GET', `${own}/commands?after=0`, token);
    await pause(exchangeSeconds * (0.9 + 0.2 * random.uniform()));
  }
  return acknowledged;
}

const directory = mkdtempSync(join(tmpdir(), 'threepoint-load-'));
/** -D: the server stays the child, which is asked and killed. */
const slowDisk = (ms: number) =>
  `-D -f --seccomp-bpf -qqq -o /dev/null -e trace=fsync,fdatasync -e inject=fsync,fdatasync:delay_exit=${1000 * ms}`.split(
    ' ',
  );
const deleteImage = await provideBuiltServer();
const through = flushMs > 0 ? ['strace', ...slowDisk(flushMs)] : [];
const server = await startServer({}, { directory, through });
const times: Times = new Map();
const refused: string[] = [];
const ask = client(server.url, times, refused);
const plan = remotePlan();
await ask('begin', 'POST', '', experimenterToken, JSON.stringify({ plan, simulated: false }));
const { participants } = (await ask('overview', 'GET', `/${plan.id}/participants`, experimenterToken)) as {
  participants: ParticipantState[];
};
if (participants.length !== participantsOf(plan).length) throw new Error('the study has other participants');
const before = await server.inspect();
const start = performance.now();
const until = start + 1000 * seconds;
// The experimenter's page looks on.
const watching = (async () => {
  while (performance.now() < until) {
    await ask('overview', 'GET', `/${plan.id}/participants`, experimenterToken);
    await pause(exchangeSeconds);
  }
})();
const acknowledged = (await Promise.all(participants.map((one) => takePart(ask, plan, one, until)))).reduce(
  (sum, one) => sum + one,
  0,
);
await watching;
const took = (performance.now() - start) / 1000;
const after = await server.inspect();
const stored = (await ask('all', 'GET', `/${plan.id}/records`, experimenterToken)) as { records: unknown[] };
await server.kill();
deleteImage();
rmSync(directory, { recursive: true, force: true });

const requests = [...times].map(([kind, ms]) => ({
  kind,
  requests: ms.length,
  p50Ms: Math.round(10 * quantile(ms, 0.5)) / 10,
  p99Ms: Math.round(10 * quantile(ms, 0.99)) / 10,
  maxMs: Math.round(quantile(ms, 1)),
}));
const figures = {
  participants: count,
  flushMs,
  seconds: Math.round(took),
  cpuShare: (after.cpuSeconds - before.cpuSeconds) / took,
  rssMegabytes: after.rssBytes / 2 ** 20,
  acknowledged,
  stored: stored.records.length,
  refused: refused.length,
  sentAgain,
};
console.table([figures]);
console.table(requests);
for (const one of refused.slice(0, 5)) console.log(one);
if (options.json) writeFileSync(options.json, `${JSON.stringify({ ...figures, requests }, null, 2)}\n`);
process.exitCode = acknowledged === figures.stored && refused.length === 0 ? 0 : 1;
