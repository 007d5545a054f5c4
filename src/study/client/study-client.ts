import { reasonOf } from 'threepoint/core';
import type { Progress } from '../model/progress/progress';
import { Rejection } from '../model/progress/rejection';
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

export const noStudiesHere = 'Studies need a threepoint server, and this page comes from a host without one.';

/** There was no answer: no network, no server, or an aborted request. A later attempt may succeed. */
export class ServerUnreachable extends Error {}

interface RequestOptions {
  readonly method?: 'GET' | 'POST' | 'PUT' | 'DELETE';
  readonly token?: string;
  readonly body?: unknown;
  /** Text that is sent instead of `body`. */
  readonly text?: string;
  /** The time after which the request is aborted [ms]; null: it may take any time. */
  readonly timeoutMs?: number | null;
}

const usualTimeoutMs = 15_000;
/** The time limit while a person waits before an empty page [ms]. */
const shortTimeoutMs = 4000;
/** The time limit of an upload of a recording [ms], which is the time that the server gives a request to arrive. */
export const motionTimeoutMs = 120_000;

/** `server`: the folder of its page, no slash at its end. */
async function request(
  server: string,
  path: string,
  { method = 'GET', token, body, text, timeoutMs = usualTimeoutMs }: RequestOptions,
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
      ...(timeoutMs !== null && { signal: AbortSignal.timeout(timeoutMs) }),
    });
  } catch (error) {
    throw new ServerUnreachable(`the server does not answer (${reasonOf(error)})`);
  }
  if (response.ok) return response;
  const answer: unknown = await response.json().catch(() => null);
  const isStudyServer = typeof answer === 'object' && answer !== null && 'error' in answer;
  if (!isStudyServer && response.status === 404) throw new Rejection('elsewhere', noStudiesHere);
  const sentence = isStudyServer ? String(answer.error) : `the server answered ${response.status}`;
  // Proxies send these while the server is away. The server itself sends 5xx if nothing was acknowledged.
  if (response.status >= 500 && response.status !== 507) throw new ServerUnreachable(sentence);
  const field = typeof answer === 'object' && answer !== null && 'field' in answer ? answer.field : null;
  throw Rejection.from(response.status, sentence, typeof field === 'string' ? field : null);
}

/** Resolves with the body of an answer; rejects if it is incomplete. */
async function readBody<T>(body: Promise<T>): Promise<T> {
  try {
    return await body;
  } catch (error) {
    throw new ServerUnreachable(`the answer was incomplete (${reasonOf(error)})`);
  }
}

/** Returns a function that requests JSON from a server. */
const answersOf = (server: string) =>
  async function answer<T>(path: string, asked: RequestOptions = {}): Promise<T> {
    const response = await request(server, path, asked);
    return (response.status === 204 ? null : await readBody(response.json())) as T;
  };

const pathOf = (study: string, participant?: string) =>
  `/${encodeURIComponent(study)}${participant === undefined ? '' : `/participants/${encodeURIComponent(participant)}`}`;

const versionPart = (version: number | undefined) => (version === undefined ? '' : `?version=${version}`);

/** A participant's place in a study. */
export interface StudyPlace {
  readonly study: string;
  readonly participant: string;
}

/** A place with the token of the device that has taken it. */
export interface TakenPlace extends StudyPlace {
  readonly token: string;
}

export type ParticipantClient = ReturnType<typeof createParticipantClient>;

/** Returns the requests of a participant's page. Every call rejects with Rejection or ServerUnreachable. */
export function createParticipantClient(server: string) {
  const answer = answersOf(server);
  const ownPath = ({ study, participant }: StudyPlace, name: string) => `${pathOf(study, participant)}/${name}`;
  return {
    /** Returns the study with the text of the plan version that this participant follows. */
    study: ({ study, participant }: StudyPlace): Promise<PublicStudy> =>
      answer(`${pathOf(study)}?participant=${encodeURIComponent(participant)}`),
    /** `invitation` is taken from the link or was typed; `consent` is the version of the text that was read. */
    claim: (place: StudyPlace, invitation: string, consent: string): Promise<Claim> =>
      answer(ownPath(place, 'claim'), { method: 'POST', body: { invitation, consent } }),
    /** Resolves with the ids that are stored now. */
    async send(place: TakenPlace, records: readonly StudyRecord[]): Promise<readonly string[]> {
      const asked = { method: 'POST', token: place.token, body: { records } } as const;
      return (await answer<{ acknowledged: string[] }>(ownPath(place, 'records'), asked)).acknowledged;
    },
    /** Resolves with null if nothing was reported. */
    async progress(place: TakenPlace): Promise<Progress | null> {
      const asked = { token: place.token, timeoutMs: shortTimeoutMs };
      return (await answer<{ progress: Progress | null }>(ownPath(place, 'progress'), asked)).progress;
    },
    saveProgress: (place: TakenPlace, progress: Progress): Promise<void> =>
      answer(ownPath(place, 'progress'), { method: 'PUT', token: place.token, body: progress }),
    async commands(place: TakenPlace, after: number): Promise<readonly NumberedCommand[]> {
      const path = ownPath(place, `commands?after=${after}`);
      return (await answer<{ commands: NumberedCommand[] }>(path, { token: place.token })).commands;
    },
    sendMotion: (place: TakenPlace, trial: string, recording: string): Promise<void> =>
      answer(ownPath(place, `motion?trial=${encodeURIComponent(trial)}`), {
        method: 'PUT',
        token: place.token,
        text: recording,
        timeoutMs: motionTimeoutMs,
      }),
    /** Resolves with the participant's seat in the room of a trial that a group plays together. */
    seat: (place: TakenPlace, trial: PlayedTogether): Promise<SignedSeat> =>
      answer(ownPath(place, 'seat'), { method: 'POST', token: place.token, body: trial }),
  };
}

/** Returns the requests of the withdrawal page. Every call rejects with Rejection or ServerUnreachable. */
export function createWithdrawalClient(server: string) {
  const answer = answersOf(server);
  return {
    study: (study: string): Promise<PublicStudy> => answer(pathOf(study)),
    /** Deletes everything, or only the recordings, of the participant with this code, in any notation of the code. */
    withdraw: (study: string, code: string, only?: 'motion'): Promise<Receipt> =>
      answer(`${pathOf(study)}/withdraw`, { method: 'POST', body: { code, ...(only && { only }) } }),
  };
}

/** The server accepts bodies of 512 KiB at most. */
const recordsAtOnce = 50;

export type ExperimenterClient = ReturnType<typeof createExperimenterClient>;

/** Returns the requests of the experimenter's pages. Every call rejects with Rejection or ServerUnreachable. */
export function createExperimenterClient(token: string, server: string) {
  const answer = answersOf(server);
  const post = <T>(path: string, body?: unknown) => answer<T>(path, { method: 'POST', token, body });
  const list = async <T>(key: string, path: string) =>
    (await answer<Record<string, readonly T[]>>(path, { token }))[key] as readonly T[];
  return {
    studies: () => list<StudyListing>('studies', ''),
    /** `newVersion` allows another plan for a study that has begun. */
    addStudy: (plan: unknown, simulated: boolean, newVersion = false): Promise<StudyInfo> =>
      post('', { plan, simulated, newVersion }),
    /** Resolves with the records under this version of the plan, or under the newest one. */
    records: (study: string, version?: number): Promise<RecordedStudy> =>
      answer(`${pathOf(study)}/records${versionPart(version)}`, { token }),
    participants: (study: string) => list<ParticipantState>('participants', `${pathOf(study)}/participants`),
    receipts: (study: string) => list<Receipt>('receipts', `${pathOf(study)}/receipts`),
    command: (study: string, participant: string, command: StudyCommand): Promise<unknown> =>
      post(`${pathOf(study, participant)}/commands`, command),
    remark: (study: string, participant: string, text: string): Promise<unknown> =>
      post(`${pathOf(study, participant)}/remarks`, { text }),
    release: (study: string, participant: string): Promise<void> => post(`${pathOf(study, participant)}/release`),
    /** Makes another invitation; links with the old one stop working. */
    reinvite: (study: string, participant: string): Promise<void> => post(`${pathOf(study, participant)}/invitation`),
    /** Resolves with the zip file of a participant, or of all under a version of the plan. */
    async export(
      study: string,
      { participant, version }: { readonly participant?: string; readonly version?: number } = {},
    ) {
      // A zip file of many recordings takes minutes to make and to download.
      const asked = { token, timeoutMs: null };
      const response = await request(server, `${pathOf(study, participant)}/export${versionPart(version)}`, asked);
      const name = /filename="([^"]+)"/.exec(response.headers.get('content-disposition') ?? '')?.[1];
      return { name: name ?? `${study}.zip`, zip: await readBody(response.blob()) };
    },
    delete: (study: string, participant: string): Promise<Receipt> =>
      answer(pathOf(study, participant), { method: 'DELETE', token }),
    /** Stores a simulated participant from the first record to the last. */
    async addSimulated(study: string, { participant, records, progress }: SimulatedParticipant): Promise<void> {
      const place = pathOf(study, participant);
      await post(`${place}/claim`, {});
      for (let at = 0; at < records.length; at += recordsAtOnce) {
        await post(`${place}/records`, { records: records.slice(at, at + recordsAtOnce) });
      }
      await answer(`${place}/progress`, { method: 'PUT', token, body: progress });
    },
    deleteSimulated: (study: string): Promise<void> => answer(pathOf(study), { method: 'DELETE', token }),
  };
}
