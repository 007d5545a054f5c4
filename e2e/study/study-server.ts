import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { createExperimenterClient } from '../../src/study/client/study-client';
import { studyLink } from '../../src/study/client/study-link';
import { parsePlan, type StudyPlan } from '../../src/study/model/plan/plan';
import { scheduleFor } from '../../src/study/model/plan/schedule';
import { begin } from '../../src/study/model/progress/progress';
import type { NumberedCommand } from '../../src/study/model/progress/study-api';
import { recordVersion } from '../../src/study/model/records/study-record';

export const experimenterToken = 'tests-Zk3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';

const atRoot = (path: string) => fileURLToPath(new URL(`../../${path}`, import.meta.url));

/**
 * Starts the server as `npm start` does, with these settings, on a free port; its records are deleted when it closes.
 * `main`: Node's arguments for another build of the server.
 */
export async function serveStudies(settings: Settings = {}, main = ['--import', 'tsx', 'server/main.ts']) {
  const directory = mkdtempSync(join(tmpdir(), 'threepoint-studies-'));
  const child = spawn(process.execPath, [...main, '--port', '0', '--studies', directory], {
    cwd: atRoot('.'),
    env: { ...process.env, EXPERIMENTER_TOKEN: experimenterToken, THREEPOINT_LOG_LEVEL: 'error', ...settings },
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  let said = '';
  const port = await new Promise<string>((resolve, reject) => {
    child.stdout.setEncoding('utf8').on('data', (text: string) => {
      said += text;
      const found = /http:\/\/localhost:(\d+)/.exec(said)?.[1];
      if (found) resolve(found);
    });
    child.once('exit', (code) => reject(new Error(`the server ended with ${code} before it listened: ${said}`)));
  });
  return {
    origin: `http://localhost:${port}`,
    async close() {
      const gone = once(child, 'exit');
      child.kill('SIGTERM');
      await gone;
      rmSync(directory, { recursive: true, force: true });
    },
  };
}

type Settings = Readonly<Record<string, string>>;
export type Serve = (settings?: Settings) => ReturnType<typeof serveStudies>;

/** A fixture that starts servers, each with these and its own settings. They close when the test ends. */
export async function provideServers(use: (serve: Serve) => Promise<void>, shared: Settings = {}): Promise<void> {
  const servers: Awaited<ReturnType<Serve>>[] = [];
  await use(async (settings = {}) => {
    const server = await serveStudies({ ...shared, ...settings });
    servers.push(server);
    return server;
  });
  for (const server of servers) await server.close();
}

/** Returns a shipped study, under this id. */
export const shippedPlan = (name: 'example' | 'latency' | 'paper', id: string = name): StudyPlan => ({
  ...parsePlan(readFileSync(atRoot(`public/studies/${name}.json`), 'utf8'), `${name}.json`),
  id,
});

/** Returns a shipped study with one of its games, for three participants, with short trials and 2 s of practice. */
export function shortStudy(
  id: string,
  of: 'example' | 'paper' = 'paper',
  game = 'archery',
  trialSeconds = 5,
): StudyPlan {
  const { tasks, hypotheses: _, ...plan } = shippedPlan(of, id);
  return {
    ...plan,
    participants: 3,
    tasks: tasks
      .filter((task) => task.game === game)
      .map((task) => ({
        ...task,
        trialSeconds,
        restSeconds: 1,
        tutorial: { ...task.tutorial, seconds: 2, restSeconds: 0 },
      })),
  };
}

/** Returns a study without practice. */
export const withoutPractice = (plan: StudyPlan): StudyPlan => ({
  ...plan,
  tasks: plan.tasks.map((task) => ({ ...task, tutorial: { ...task.tutorial, when: 'never' } })),
});

/** A client of the experimenter's API of a server, which acts for participants too. */
export function experimenter(origin: string) {
  const client = createExperimenterClient(experimenterToken, origin);
  const ask = (path: string, method = 'GET', body?: unknown) =>
    fetch(`${origin}/api/studies${path}`, {
      method,
      headers: { authorization: `Bearer ${experimenterToken}`, 'content-type': 'application/json' },
      ...(body !== undefined && { body: JSON.stringify(body) }),
    });
  return {
    ...client,
    ask,
    /** Returns a participant's link as the experimenter's page shows it, with additional parameters of the page. */
    async link(study: string, participant: string, switches = ''): Promise<string> {
      const states = await client.participants(study);
      const invitation = states.find((one) => one.participant === participant)?.invitation ?? null;
      return new URL(studyLink({ study, participant, invitation }).replace('#', `${switches}#`), origin).href;
    },
    /** Claims a participant's place and consents; returns the place's path in the API. */
    async consented({ id: study, consent }: StudyPlan, participant: string): Promise<string> {
      const place = `/${study}/participants/${participant}`;
      const at = Date.now() / 1000;
      const body = { version: consent.version, given: true, motion: false, at };
      const record = {
        version: recordVersion,
        id: 'consent',
        study,
        participant,
        simulated: false,
        at,
        kind: 'consent',
        body,
      };
      for (const [path, sent] of [
        ['/claim', {}],
        ['/records', { records: [record] }],
      ] as const) {
        const response = await ask(`${place}${path}`, 'POST', sent);
        if (!response.ok) throw new Error(`${participant} did not get to ${path}: ${await response.text()}`);
      }
      return place;
    },
    /** Reports that a participant who has consented is at this step, as the participant's page does. */
    async report(plan: StudyPlan, participant: string, step: string, running = false): Promise<void> {
      const progress = { ...begin(scheduleFor(plan, participant)), motion: false, step, running };
      const { status } = await ask(`/${plan.id}/participants/${participant}/progress`, 'PUT', progress);
      if (status !== 204) throw new Error(`the step of ${participant} was not stored: ${status}`);
    },
    /** Returns the experimenter's commands to a participant. */
    async commands(study: string, participant: string): Promise<readonly NumberedCommand[]> {
      const response = await ask(`/${study}/participants/${participant}/commands`);
      return ((await response.json()) as { commands: NumberedCommand[] }).commands;
    },
  };
}
