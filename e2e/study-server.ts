import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import type { IncomingMessage, ServerResponse } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { createPageHandler } from '../server/page';
import { createRelay, type Relay } from '../server/relay';
import { relayConfigurationFrom } from '../server/relay-configuration';
import { openStudyService } from '../server/study-service';
import { serve } from '../server/web-server';
import { parsePlan, type StudyPlan } from '../src/core/study/plan';

export const experimenterToken = 'a-token-for-tests-alone';

const atRoot = (path: string) => fileURLToPath(new URL(`../${path}`, import.meta.url));

/** The built page and its studies, as `npm start` serves them; what is recorded is gone when it closes. */
export async function serveStudies() {
  const directory = mkdtempSync(join(tmpdir(), 'threepoint-studies-'));
  const service = openStudyService({
    directory,
    token: experimenterToken,
    now: () => Date.now() / 1000,
    log: (line) => console.error(line),
  });
  const page = createPageHandler(atRoot('dist'));
  let relay: Relay | null = null;
  const server = await serve(
    (request: IncomingMessage, response: ServerResponse) => {
      if (!relay?.handle(request, response) && !service.handle(request, response)) page(request, response);
    },
    { host: '127.0.0.1', port: 0 },
  );
  relay = createRelay(
    server.requests,
    relayConfigurationFrom({ THREEPOINT_LOG_LEVEL: 'silent' }),
    'a-secret-for-tests-alone-of-a-length',
  );
  return {
    origin: `http://localhost:${server.port}`,
    async close() {
      await relay?.close();
      await server.close();
      service.close();
      rmSync(directory, { recursive: true, force: true });
    },
  };
}

/** The paper's study with its times cut short, archery alone. */
export function shortStudy(id: string): StudyPlan {
  const paper = parsePlan(readFileSync(atRoot('public/studies/paper.json'), 'utf8'), 'paper.json');
  return {
    ...paper,
    id,
    participants: 4,
    tasks: paper.tasks
      .filter(({ game }) => game === 'archery')
      .map((task) => ({
        ...task,
        trialSeconds: 5,
        tutorial: { ...task.tutorial, seconds: 2, restSeconds: 0 },
        restSeconds: 1,
      })),
  };
}

/** The ball game alone, for one group of three, cut short, without practice and questionnaire time. */
export function shortBallStudy(id: string): StudyPlan {
  const paper = parsePlan(readFileSync(atRoot('public/studies/paper.json'), 'utf8'), 'paper.json');
  return {
    ...paper,
    id,
    participants: 3,
    tasks: paper.tasks
      .filter(({ game }) => game === 'ball')
      .map((task) => ({
        ...task,
        trialSeconds: 10,
        tutorial: { ...task.tutorial, when: 'never' },
        restSeconds: 1,
      })),
  };
}

/** Speaks to the experimenter's side of a server. */
export function experimenter(origin: string) {
  const ask = (path: string, method = 'GET', body?: unknown) =>
    fetch(`${origin}/api/studies${path}`, {
      method,
      headers: { authorization: `Bearer ${experimenterToken}`, 'content-type': 'application/json' },
      ...(body !== undefined && { body: JSON.stringify(body) }),
    });
  return {
    ask,
    async begin(plan: StudyPlan, simulated: boolean): Promise<void> {
      const response = await ask('', 'POST', { plan, simulated });
      if (!response.ok) throw new Error(`the study "${plan.id}" was not begun: ${await response.text()}`);
    },
  };
}
