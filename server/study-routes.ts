import { createHash, timingSafeEqual } from 'node:crypto';
import type { IncomingMessage, ServerResponse } from 'node:http';
import * as v from 'valibot';
import { checkedPlan, type StudyPlan } from '../src/core/study/plan';
import { checkedRecord } from '../src/core/study/study-record';
import {
  checked,
  identifier,
  integerBetween,
  participantId,
  text,
  ValidationError,
} from '../src/core/study/validation';
import { parseRecording } from '../src/core/tracking/recording';
import { securityHeaders } from './security-headers';
import { exportName, exportZip } from './study-export';
import { StoreRefusal, type StudyStore } from './study-store';

export interface StudyRoutesOptions {
  readonly store: StudyStore;
  /** Whoever sends this as "Authorization: Bearer …" is an experimenter; null: nobody is. */
  readonly experimenterToken: string | null;
  /** Seconds since 1970. */
  readonly now: () => number;
  /** Told of faults of ours; the participant hears only that there was one. */
  readonly onFault: (error: unknown) => void;
}

/** Longest bodies [bytes]. */
export const bodyLimits = { json: 512 * 1024, motion: 16 * 2 ** 20 } as const;
export const mostRecordsAtOnce = 200;
export const shortestExperimenterToken = 16;

const prefix = '/api/studies';

/** An answer other than "done", for the person at the other end. */
class HttpError extends Error {
  readonly status: number;
  readonly field: string | null;

  constructor(status: number, message: string, field: string | null = null) {
    super(message);
    this.status = status;
    this.field = field;
  }
}

interface Call {
  readonly request: IncomingMessage;
  readonly query: URLSearchParams;
  /** From the address: the study and, where the route has one, the participant. */
  readonly study: string;
  readonly participant: string;
}

type Answer =
  | { readonly status?: number; readonly json: unknown }
  | { readonly zip: Uint8Array; readonly name: string }
  | { readonly status: 204 };

interface Route {
  readonly method: 'GET' | 'POST' | 'PUT' | 'DELETE';
  /** Below the prefix; ":study" and ":participant" stand for names. */
  readonly path: string;
  /** participant: with the token of this very participant, or as an experimenter. */
  readonly access: 'anyone' | 'participant' | 'experimenter';
  handle(call: Call): Answer | Promise<Answer>;
}

async function bodyOf(request: IncomingMessage, limit: number): Promise<string> {
  const tooLong = () => new HttpError(413, `a body has at most ${limit} bytes`);
  if (!/^application\/json(;|$)/i.test(request.headers['content-type'] ?? '')) {
    throw new HttpError(415, 'send application/json');
  }
  if (Number(request.headers['content-length'] ?? 0) > limit) throw tooLong();
  const chunks: Buffer[] = [];
  let length = 0;
  for await (const chunk of request) {
    length += (chunk as Buffer).length;
    if (length > limit) throw tooLong();
    chunks.push(chunk as Buffer);
  }
  return Buffer.concat(chunks).toString('utf8');
}

async function jsonOf(request: IncomingMessage): Promise<unknown> {
  const body = await bodyOf(request, bodyLimits.json);
  try {
    return JSON.parse(body);
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    throw new HttpError(400, `the body is no JSON: ${error.message}`);
  }
}

const batchSchema = v.object({
  records: v.pipe(
    v.array(v.unknown(), 'expected a list'),
    v.minLength(1, 'expected at least one record'),
    v.maxLength(mostRecordsAtOnce, `expected at most ${mostRecordsAtOnce} records`),
  ),
});

const commandSchema = v.variant('type', [
  v.strictObject({ type: v.literal('start') }),
  v.strictObject({ type: v.literal('pause') }),
  v.strictObject({ type: v.literal('resume') }),
  v.strictObject({ type: v.literal('void-block'), reason: text(500), repeat: v.boolean('expected true or false') }),
]);

const newStudySchema = v.strictObject({ plan: v.unknown(), simulated: v.boolean('expected true or false') });
const trialId = v.pipe(v.string(), v.regex(/^[a-z0-9][a-z0-9/@.:-]{0,119}$/, 'expected the id of a trial record'));

const digest = (secret: string) => createHash('sha256').update(secret).digest();

function bearerOf(request: IncomingMessage): string | null {
  return /^Bearer ([\w~+/.-]{1,256}=*)$/.exec(request.headers.authorization ?? '')?.[1] ?? null;
}

/** What a participant may know of a plan: the order and names of conditions come only with their own schedule. */
const publicPlan = ({ id, title, consent }: StudyPlan, simulated: boolean) => ({ id, title, consent, simulated });

const statusOfRefusal = { unknown: 404, conflict: 409, forbidden: 403, full: 507 } as const;

/**
 * The study's part of the server: answers requests below /api/studies and returns true; false for any other request. Bodies are
 * JSON, bounded and validated; errors are {"error", "field"}. A participant's token opens nothing but that participant.
 */
export function createStudyRoutes({
  store,
  experimenterToken,
  now,
  onFault,
}: StudyRoutesOptions): (request: IncomingMessage, response: ServerResponse) => boolean {
  if (experimenterToken !== null && experimenterToken.length < shortestExperimenterToken) {
    throw new Error(`the experimenter's token needs at least ${shortestExperimenterToken} characters`);
  }
  const experimenterDigest = experimenterToken === null ? null : digest(experimenterToken);

  const isExperimenter = (request: IncomingMessage) => {
    const token = bearerOf(request);
    return token !== null && experimenterDigest !== null && timingSafeEqual(digest(token), experimenterDigest);
  };

  const mayRead = ({ access }: Route, { request, study, participant }: Call) => {
    if (access === 'anyone' || isExperimenter(request)) return true;
    const token = bearerOf(request);
    return access === 'participant' && token !== null && store.holds(study, participant, token);
  };

  const contentOf = (study: string, participant?: string) => {
    const { plan, simulated, retentionUntil } = store.study(study);
    const records = store.records(study, participant);
    return { plan, simulated, records, motion: store.motion(study, participant), at: now(), retentionUntil };
  };

  const routes: readonly Route[] = [
    {
      method: 'GET',
      path: '',
      access: 'experimenter',
      handle: () => ({
        json: {
          studies: store
            .studies()
            .map(({ plan: { id, title, participants }, ...rest }) => ({ id, title, participants, ...rest })),
        },
      }),
    },
    {
      method: 'POST',
      path: '',
      access: 'experimenter',
      handle: async ({ request }) => {
        const { plan, simulated } = checked(newStudySchema, await jsonOf(request));
        return { status: 201, json: store.addStudy(checkedPlan(plan), { simulated, at: now() }) };
      },
    },
    {
      method: 'GET',
      path: '/:study',
      access: 'anyone',
      handle: ({ study }) => {
        const { plan, simulated } = store.study(study);
        return { json: publicPlan(plan, simulated) };
      },
    },
    {
      method: 'GET',
      path: '/:study/records',
      access: 'experimenter',
      handle: ({ study }) => ({ json: { ...store.study(study), records: store.records(study) } }),
    },
    {
      method: 'GET',
      path: '/:study/receipts',
      access: 'experimenter',
      handle: ({ study }) => {
        store.study(study);
        return { json: { receipts: store.receipts(study) } };
      },
    },
    {
      method: 'GET',
      path: '/:study/export',
      access: 'experimenter',
      handle: ({ study }) => {
        const content = contentOf(study);
        return { zip: exportZip(content), name: exportName(content) };
      },
    },
    {
      method: 'POST',
      path: '/:study/withdraw',
      access: 'anyone',
      handle: async ({ request, study }) => {
        const { code } = checked(v.object({ code: text(60) }), await jsonOf(request));
        store.study(study);
        const receipt = store.withdraw(study, code, now());
        if (!receipt) throw new HttpError(404, 'nothing is recorded under this code');
        return { json: receipt };
      },
    },
    {
      method: 'GET',
      path: '/:study/participants',
      access: 'experimenter',
      handle: ({ study }) => ({ json: { participants: store.overview(study, now()) } }),
    },
    {
      method: 'POST',
      path: '/:study/participants/:participant/claim',
      access: 'anyone',
      handle: ({ study, participant }) => {
        const { plan, simulated } = store.study(study);
        const { token, withdrawalCode } = store.claim(study, participant, now());
        // A session that another device began goes on where that one was.
        const progress = store.progress(study, participant);
        return { status: 201, json: { token, withdrawalCode, plan, simulated, progress } };
      },
    },
    {
      method: 'POST',
      path: '/:study/participants/:participant/release',
      access: 'experimenter',
      handle: ({ study, participant }) => {
        store.release(study, participant);
        return { status: 204 };
      },
    },
    {
      method: 'POST',
      path: '/:study/participants/:participant/records',
      access: 'participant',
      handle: async ({ request, study, participant }) => {
        const { records } = checked(batchSchema, await jsonOf(request));
        const valid = records.map((record, index) => {
          try {
            return checkedRecord(record);
          } catch (error) {
            if (!(error instanceof ValidationError)) throw error;
            throw new ValidationError(`records[${index}]${error.field && `.${error.field}`}`, error.complaint);
          }
        });
        return { json: { acknowledged: store.storeRecords(study, participant, valid, now()) } };
      },
    },
    {
      method: 'GET',
      path: '/:study/participants/:participant/records',
      access: 'participant',
      handle: ({ study, participant }) => ({ json: { records: store.records(study, participant) } }),
    },
    {
      method: 'PUT',
      path: '/:study/participants/:participant/progress',
      access: 'participant',
      handle: async ({ request, study, participant }) => {
        store.saveProgress(study, participant, await jsonOf(request), now());
        return { status: 204 };
      },
    },
    {
      method: 'GET',
      path: '/:study/participants/:participant/progress',
      access: 'participant',
      handle: ({ study, participant }) => ({ json: { progress: store.progress(study, participant) } }),
    },
    {
      method: 'GET',
      path: '/:study/participants/:participant/commands',
      access: 'participant',
      handle: ({ study, participant, query }) => {
        const after = checked(v.object({ after: integerBetween(0, 2 ** 53 - 1) }), {
          after: Number(query.get('after') ?? 0),
        });
        return { json: { commands: store.commands(study, participant, after.after) } };
      },
    },
    {
      method: 'POST',
      path: '/:study/participants/:participant/commands',
      access: 'experimenter',
      handle: async ({ request, study, participant }) => {
        const command = checked(commandSchema, await jsonOf(request));
        return { status: 201, json: { number: store.addCommand(study, participant, command, now()) } };
      },
    },
    {
      method: 'POST',
      path: '/:study/participants/:participant/remarks',
      access: 'experimenter',
      handle: async ({ request, study, participant }) => {
        const remark = checked(v.strictObject({ text: text(2000) }), await jsonOf(request));
        return { status: 201, json: { id: store.addRemark(study, participant, remark.text, now()) } };
      },
    },
    {
      method: 'PUT',
      path: '/:study/participants/:participant/motion',
      access: 'participant',
      handle: async ({ request, study, participant, query }) => {
        const { trial } = checked(v.object({ trial: trialId }), { trial: query.get('trial') });
        const body = await bodyOf(request, bodyLimits.motion);
        try {
          parseRecording(body);
        } catch (error) {
          throw new HttpError(400, (error as Error).message);
        }
        store.storeMotion(study, participant, trial, body, now());
        return { status: 204 };
      },
    },
    {
      method: 'GET',
      path: '/:study/participants/:participant/export',
      access: 'participant',
      handle: ({ study, participant }) => {
        const content = contentOf(study, participant);
        return { zip: exportZip(content, participant), name: exportName(content, participant) };
      },
    },
    {
      method: 'DELETE',
      path: '/:study/participants/:participant',
      access: 'experimenter',
      handle: ({ study, participant }) => ({
        json: store.deleteParticipant(study, participant, 'experimenter', now()),
      }),
    },
  ];

  const matchers = routes.map((route) => ({
    route,
    pattern: new RegExp(
      `^${route.path.replace(':study', '(?<study>[^/]+)').replace(':participant', '(?<participant>[^/]+)')}/?$`,
    ),
  }));

  async function answerTo(request: IncomingMessage, path: string, query: URLSearchParams): Promise<Answer> {
    const matching = matchers.flatMap(({ route, pattern }) => {
      const match = pattern.exec(path);
      return match ? [{ route, names: match.groups ?? {} }] : [];
    });
    if (matching.length === 0) throw new HttpError(404, 'there is nothing at this address');
    const found = matching.find(({ route }) => route.method === request.method);
    if (!found)
      throw new HttpError(405, `this address answers ${matching.map(({ route }) => route.method).join(', ')}`);
    const { route, names } = found;
    const call: Call = {
      request,
      query,
      study: names.study === undefined ? '' : checked(identifier, names.study),
      participant: names.participant === undefined ? '' : checked(participantId, names.participant),
    };
    if (!mayRead(route, call))
      throw new HttpError(401, 'this needs the token of the participant or of an experimenter');
    return route.handle(call);
  }

  function send(response: ServerResponse, answer: Answer): void {
    const headers = { ...securityHeaders, 'cache-control': 'no-store' };
    if ('zip' in answer) {
      response.writeHead(200, {
        ...headers,
        'content-type': 'application/zip',
        'content-disposition': `attachment; filename="${answer.name}.zip"`,
        'content-length': answer.zip.length,
      });
      response.end(answer.zip);
    } else if ('json' in answer) {
      response.writeHead(answer.status ?? 200, { ...headers, 'content-type': 'application/json; charset=utf-8' });
      response.end(`${JSON.stringify(answer.json)}\n`);
    } else {
      response.writeHead(answer.status, headers);
      response.end();
    }
  }

  function refusalOf(error: unknown): { status: number; json: { error: string; field: string | null } } {
    if (error instanceof HttpError) return { status: error.status, json: { error: error.message, field: error.field } };
    if (error instanceof ValidationError) {
      return { status: 400, json: { error: error.message, field: error.field || null } };
    }
    if (error instanceof StoreRefusal) {
      return { status: statusOfRefusal[error.reason], json: { error: error.message, field: null } };
    }
    onFault(error);
    return {
      status: 500,
      json: { error: 'the server could not store or read this; nothing was acknowledged', field: null },
    };
  }

  return (request, response) => {
    const url = new URL(request.url ?? '/', 'http://study.invalid');
    if (url.pathname !== prefix && !url.pathname.startsWith(`${prefix}/`)) return false;
    answerTo(request, url.pathname.slice(prefix.length), url.searchParams)
      .catch((error: unknown) => {
        // What was not read of a refused body would be taken for the next request.
        if (!request.complete) response.setHeader('connection', 'close');
        return refusalOf(error);
      })
      .then((answer) => send(response, answer))
      .catch((error: unknown) => {
        onFault(error);
        response.destroy();
      });
    return true;
  };
}
