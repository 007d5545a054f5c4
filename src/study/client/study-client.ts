import { reasonOf } from 'threepoint/core/errors/reasons';
import type { Progress } from '../model/progress/progress';
import type {
  Claim,
  NumberedCommand,
  ParticipantState,
  PlayedTogether,
  PublicStudy,
  Receipt,
  RecordedStudy,
  SignedSeat,
  StudyCommand,
  StudyInfo,
  StudyListing,
} from '../model/progress/study-api';
import type { StudyRecord } from '../model/records/study-record';
import type { SimulatedParticipant } from '../simulation/simulate-study';

/** The server answered and refused the request. */
export class ServerRefusal extends Error {
  readonly status: number;
  /** The invalid field of the request, as `records[1].body.age`; null: no single field is at fault. */
  readonly field: string | null;

  constructor(status: number, message: string, field: string | null = null) {
    super(message);
    this.status = status;
    this.field = field;
  }
}

/** The message for a host without studies. */
export const noStudiesHere = 'Studies need a threepoint server, and this page comes from a host without one.';

/** The server that answered does not know studies: it is another program, and its answer has no message. */
export class NoStudyServer extends ServerRefusal {
  constructor(status: number) {
    super(status, noStudiesHere);
  }
}

/** There was no answer: no network, no server, or an aborted request. A later attempt may succeed. */
export class ServerUnreachable extends Error {}

interface Asked {
  readonly method?: 'GET' | 'POST' | 'PUT' | 'DELETE';
  readonly token?: string;
  readonly body?: unknown;
  /** Text that is sent instead of `body`. */
  readonly text?: string;
  /** The time after which the request is aborted [ms]; null: it may take any time. */
  readonly patienceMs?: number | null;
}

const usualPatienceMs = 15_000;
/** The time limit while a person waits before an empty page [ms]. */
const shortPatienceMs = 4000;
/** The time limit of an upload of a recording [ms], which is the time that the server gives a request to arrive. */
export const motionPatienceMs = 120_000;

/** `server`: the folder of its page, no slash at its end. */
async function ask(
  server: string,
  path: string,
  { method = 'GET', token, body, text, patienceMs = usualPatienceMs }: Asked,
): Promise<Response> {
  const content = text ?? (body === undefined ? undefined : JSON.stringify(body));
  let response: Response;
  try {
    response = await fetch(`${server}/api/studies${path}`, {
      method,
      headers: {
        ...(token && { authorization: `Bearer ${token}` }),
        ...(content !== undefined && { 'content-type': 'application/json' }),
      },
      ...(content !== undefined && { body: content }),
      cache: 'no-store',
      ...(patienceMs !== null && { signal: AbortSignal.timeout(patienceMs) }),
    });
  } catch (error) {
    throw new ServerUnreachable(`the server does not answer (${reasonOf(error)})`);
  }
  if (response.ok) return response;
  const answer: unknown = await response.json().catch(() => null);
  const isStudyServer = typeof answer === 'object' && answer !== null && 'error' in answer;
  if (!isStudyServer && response.status === 404) throw new NoStudyServer(response.status);
  const sentence = isStudyServer ? String(answer.error) : `the server answered ${response.status}`;
  // Proxies send these while the server is away. The server itself sends 5xx if nothing was acknowledged.
  if (response.status >= 500 && response.status !== 507) throw new ServerUnreachable(sentence);
  const field = typeof answer === 'object' && answer !== null && 'field' in answer ? answer.field : null;
  throw new ServerRefusal(response.status, sentence, typeof field === 'string' ? field : null);
}

/** Resolves with the body of an answer; rejects if it is incomplete. */
async function whole<T>(body: Promise<T>): Promise<T> {
  try {
    return await body;
  } catch (error) {
    throw new ServerUnreachable(`the answer was incomplete (${reasonOf(error)})`);
  }
}

/** Returns a function that requests JSON from a server. */
const answersOf = (server: string) =>
  async function answer<T>(path: string, asked: Asked = {}): Promise<T> {
    const response = await ask(server, path, asked);
    return (response.status === 204 ? null : await whole(response.json())) as T;
  };

const of = (study: string, participant?: string) =>
  `/${encodeURIComponent(study)}${participant === undefined ? '' : `/participants/${encodeURIComponent(participant)}`}`;

const versionPart = (version: number | undefined) => (version === undefined ? '' : `?version=${version}`);

/** The requests of a participant's page to the server. Every call rejects with ServerRefusal or ServerUnreachable. */
export interface ParticipantClient {
  /** Returns the study with the text of the plan version that this participant follows. */
  study(study: string, participant: string): Promise<PublicStudy>;
  /** `invitation` is taken from the link or was typed; `consent` is the version of the text that was read. */
  claim(study: string, participant: string, invitation: string, consent: string): Promise<Claim>;
  /** Resolves with the ids that are stored now. */
  send(study: string, participant: string, token: string, records: readonly StudyRecord[]): Promise<readonly string[]>;
  /** Resolves with null if nothing was reported. */
  progress(study: string, participant: string, token: string): Promise<Progress | null>;
  saveProgress(study: string, participant: string, token: string, progress: Progress): Promise<void>;
  commands(study: string, participant: string, token: string, after: number): Promise<readonly NumberedCommand[]>;
  sendMotion(study: string, participant: string, token: string, trial: string, recording: string): Promise<void>;
  /** Resolves with the participant's seat in the room of a trial that a group plays together. */
  seat(study: string, participant: string, token: string, trial: PlayedTogether): Promise<SignedSeat>;
}

export function createParticipantClient(server: string): ParticipantClient {
  const answer = answersOf(server);
  return {
    study: (study, participant) => answer(`${of(study)}?participant=${encodeURIComponent(participant)}`),
    claim: (study, participant, invitation, consent) =>
      answer(`${of(study, participant)}/claim`, { method: 'POST', body: { invitation, consent } }),
    async send(study, participant, token, records) {
      const path = `${of(study, participant)}/records`;
      return (await answer<{ acknowledged: string[] }>(path, { method: 'POST', token, body: { records } }))
        .acknowledged;
    },
    async progress(study, participant, token) {
      const asked = { token, patienceMs: shortPatienceMs };
      return (await answer<{ progress: Progress | null }>(`${of(study, participant)}/progress`, asked)).progress;
    },
    saveProgress: (study, participant, token, progress) =>
      answer(`${of(study, participant)}/progress`, { method: 'PUT', token, body: progress }),
    async commands(study, participant, token, after) {
      const path = `${of(study, participant)}/commands?after=${after}`;
      return (await answer<{ commands: NumberedCommand[] }>(path, { token })).commands;
    },
    sendMotion: (study, participant, token, trial, recording) =>
      answer(`${of(study, participant)}/motion?trial=${encodeURIComponent(trial)}`, {
        method: 'PUT',
        token,
        text: recording,
        patienceMs: motionPatienceMs,
      }),
    seat: (study, participant, token, trial) =>
      answer(`${of(study, participant)}/seat`, { method: 'POST', token, body: trial }),
  };
}

/** The requests of the withdrawal page. Every call rejects with ServerRefusal or ServerUnreachable. */
export interface WithdrawalClient {
  /** Returns the public part of the study. */
  study(study: string): Promise<PublicStudy>;
  /** Deletes everything of the participant who has this code, in any notation of the code. */
  withdraw(study: string, code: string): Promise<Receipt>;
}

export function createWithdrawalClient(server: string): WithdrawalClient {
  const answer = answersOf(server);
  return {
    study: (study) => answer(of(study)),
    withdraw: (study, code) => answer(`${of(study)}/withdraw`, { method: 'POST', body: { code } }),
  };
}

/** The server accepts bodies of 512 KiB at most. */
const recordsAtOnce = 50;

/** The requests of the experimenter's pages to the server. */
export interface ExperimenterClient {
  studies(): Promise<readonly StudyListing[]>;
  /** `newVersion` allows another plan for a study that has begun. */
  addStudy(plan: unknown, simulated: boolean, newVersion?: boolean): Promise<StudyInfo>;
  /** Resolves with the records under this version of the plan, or under the newest one. */
  records(study: string, version?: number): Promise<RecordedStudy>;
  participants(study: string): Promise<readonly ParticipantState[]>;
  receipts(study: string): Promise<readonly Receipt[]>;
  command(study: string, participant: string, command: StudyCommand): Promise<void>;
  remark(study: string, participant: string, text: string): Promise<void>;
  release(study: string, participant: string): Promise<void>;
  /** Makes another invitation; links with the old one stop working. */
  reinvite(study: string, participant: string): Promise<void>;
  /** Resolves with the zip file of a participant, or of all under a version of the plan. */
  export(
    study: string,
    of?: { readonly participant?: string; readonly version?: number },
  ): Promise<{ readonly name: string; readonly zip: Blob }>;
  delete(study: string, participant: string): Promise<Receipt>;
  /** Stores a simulated participant from the first record to the last. */
  addSimulated(study: string, simulated: SimulatedParticipant): Promise<void>;
  /** Deletes a simulated study completely. */
  deleteSimulated(study: string): Promise<void>;
}

export function createExperimenterClient(token: string, server: string): ExperimenterClient {
  const answer = answersOf(server);
  return {
    studies: async () => (await answer<{ studies: StudyListing[] }>('', { token })).studies,
    addStudy: (plan, simulated, newVersion = false) =>
      answer('', { method: 'POST', token, body: { plan, simulated, newVersion } }),
    records: (study, version) => answer(`${of(study)}/records${versionPart(version)}`, { token }),
    participants: async (study) =>
      (await answer<{ participants: ParticipantState[] }>(`${of(study)}/participants`, { token })).participants,
    receipts: async (study) => (await answer<{ receipts: Receipt[] }>(`${of(study)}/receipts`, { token })).receipts,
    async command(study, participant, command) {
      await answer(`${of(study, participant)}/commands`, { method: 'POST', token, body: command });
    },
    async remark(study, participant, text) {
      await answer(`${of(study, participant)}/remarks`, { method: 'POST', token, body: { text } });
    },
    release: (study, participant) => answer(`${of(study, participant)}/release`, { method: 'POST', token }),
    reinvite: (study, participant) => answer(`${of(study, participant)}/invitation`, { method: 'POST', token }),
    async export(study, { participant, version } = {}) {
      // A zip file of many recordings takes minutes to make and to download.
      const asked = { token, patienceMs: null };
      const response = await ask(server, `${of(study, participant)}/export${versionPart(version)}`, asked);
      const name = /filename="([^"]+)"/.exec(response.headers.get('content-disposition') ?? '')?.[1];
      return { name: name ?? `${study}.zip`, zip: await whole(response.blob()) };
    },
    delete: (study, participant) => answer(of(study, participant), { method: 'DELETE', token }),
    async addSimulated(study, { participant, records, progress }) {
      const place = of(study, participant);
      await answer(`${place}/claim`, { method: 'POST', token, body: {} });
      for (let at = 0; at < records.length; at += recordsAtOnce) {
        const body = { records: records.slice(at, at + recordsAtOnce) };
        await answer(`${place}/records`, { method: 'POST', token, body });
      }
      await answer(`${place}/progress`, { method: 'PUT', token, body: progress });
    },
    deleteSimulated: (study) => answer(of(study), { method: 'DELETE', token }),
  };
}
