import { readFileSync } from 'node:fs';
import type { joinMessage } from '../rooms/room/test-room';

/** Who sends a request. */
export const httpRoles = {
  stranger: 'a program or page without any secret',
  network: 'the same, by the server’s address on the network',
  otherSite: 'a page of another site, with the experimenter’s token',
  pointedHere: 'a page of another site whose name was pointed at this machine (DNS rebinding)',
  participant: 'the participant that the address names',
  otherParticipant: 'another participant of the study',
  experimenter: 'the holder of the experimenter’s token',
} as const;
export type HttpRole = keyof typeof httpRoles;

/** The holder of a secret of one route alone. */
type SecretRole = 'invited' | 'withdrawing' | 'admin' | 'this machine' | 'player';
const secretRoles: readonly SecretRole[] = ['invited', 'withdrawing', 'admin', 'this machine', 'player'];

/** What a well-formed request sends. */
interface SentRequest {
  readonly json?: 'plan' | 'records' | 'progress' | 'motion' | 'seat' | Readonly<Record<string, unknown>>;
  /** Behind the path. */
  readonly query?: string;
}

/** Statuses of a well-formed request, by who sends it. */
export interface HttpRow extends SentRequest {
  readonly status: Readonly<Record<HttpRole, number>>;
  readonly also: { readonly who: SecretRole; readonly status: number } | null;
}

const inMeadow = { query: '?room=meadow' };
const place = '/api/studies/:study/participants/:participant';

/** What the requests send that need more than their path. */
const sent: Readonly<Record<string, SentRequest>> = {
  'POST /api/rooms/match': { json: { kind: 'ball' } },
  'POST /api/rooms/new': { json: { kind: 'ball' } },
  'POST /api/rooms/token': { json: { room: 'meadow', kind: 'ball' } },
  'POST /api/rooms/end': { json: { room: 'meadow' } },
  'GET /api/avatars': inMeadow,
  'GET /api/avatars/:hash': inMeadow,
  'PUT /api/avatars/:hash': inMeadow,
  'GET /api/voices': inMeadow,
  'POST /api/studies': { json: 'plan' },
  'POST /api/studies/:study/withdraw': { json: { code: 'ZZZZ-ZZZZ-ZZZZ-ZZZZ' } },
  [`POST ${place}/claim`]: { json: {} },
  [`POST ${place}/records`]: { json: 'records' },
  [`PUT ${place}/progress`]: { json: 'progress' },
  [`POST ${place}/commands`]: { json: { type: 'pause' } },
  [`POST ${place}/remarks`]: { json: { text: 'tall' } },
  [`PUT ${place}/motion`]: { json: 'motion', query: '?trial=archery/1/trial-1' },
  [`POST ${place}/seat`]: { json: 'seat' },
};

const page = readFileSync(new URL('../../docs/security.md', import.meta.url), 'utf8');

/** Returns the rows of a list of docs/security.md: each name with the line of outcomes that it stands under. */
function rowsOf(title: string): (readonly [name: string, outcomes: string])[] {
  const [, list = ''] = page.split(`### ${title}\n`);
  let outcomes = '';
  return (list.split('\n#')[0] ?? '').split('\n').flatMap((line) => {
    const name = /^- `([^`]+)`/.exec(line)?.[1];
    if (name) return [[name, outcomes] as const];
    if (line) outcomes = line;
    return [];
  });
}

const forOtherSites = ', other sites too';

/** Reads a line of outcomes, such as “experimenter: **200**; others: 401”; returns the outcome of a role. */
function outcomesIn(line: string): (role: string) => string | undefined {
  const outcomes = new Map(
    line
      .replace(forOtherSites, '')
      .replaceAll('*', '')
      .split('; ')
      .flatMap((part) => {
        const [roles = '', outcome = ''] = part.split(': ');
        return roles.split(', ').map((role) => [role, outcome] as const);
      }),
  );
  return (role) => outcomes.get(role);
}

/** Returns the outcome of every role by a line of outcomes. */
function byRole<Role extends string>(roles: readonly Role[], line: string): Record<Role, string> {
  const outcome = outcomesIn(line);
  const usual = outcome('others') ?? outcome('all') ?? '';
  return Object.fromEntries(roles.map((role) => [role, outcome(role) ?? usual])) as Record<Role, string>;
}

function httpRow(name: string, line: string): HttpRow {
  const outcomes = byRole(Object.keys(httpRoles) as HttpRole[], line);
  // What a page of another site or name gets, unless the line says more.
  const shut = { ...(!line.endsWith(forOtherSites) && { otherSite: 403 }), pointedHere: 421 };
  const status = Object.fromEntries(Object.entries(outcomes).map(([role, text]) => [role, Number(text)]));
  const outcome = outcomesIn(line);
  const who = secretRoles.find((role) => outcome(role));
  return {
    ...sent[name],
    status: { ...(status as HttpRow['status']), ...shut },
    also: who ? { who, status: Number(outcome(who)) } : null,
  };
}

/** One row for every route of the server: a route without one fails tests/server/access.test.ts. */
export const httpRows: Readonly<Record<string, HttpRow>> = Object.fromEntries(
  rowsOf('Requests').map(([name, line]) => [name, httpRow(name, line)]),
);

/** Who speaks to a room. */
export const socketRoles = {
  player: 'the holder of a pass, on a seat of a room that is open to all',
  spectator: 'the holder of such a pass, watching',
  participant: 'a participant in the room of their trial',
  experimenter: 'an experimenter, watching there',
} as const;
export type SocketRole = keyof typeof socketRoles;

/** The type of a message of a client. */
export type MessageType = ReturnType<typeof joinMessage>['type'];

/** The outcome of every message of a client, and of what is none: taken, ends, or the room's reason of refusal. */
export const socketRows = Object.fromEntries(
  rowsOf('Messages').map(([name, line]) => [name, byRole(Object.keys(socketRoles) as SocketRole[], line)]),
);

/** Who sets the terms of a room: anyone by asking for a pass to an open room, or the study service by signed seats. */
export type TermRole = 'stranger' | 'study';

/** Values inside and outside the range of each term of a room of the ball game, and of other options of its rules. */
export const termValues: Readonly<Record<string, { inside: readonly unknown[]; outside: readonly unknown[] }>> = {
  seconds: { inside: [1, 45.5, 3600], outside: [0, 3600.5, -90, '90', null, [90]] },
  balls: { inside: [1, 20], outside: [0, 21, 2.5, '6', null] },
  waitSeconds: { inside: [1, 60, 3600], outside: [0, 3600.5, '60', null] },
  pausable: { inside: [true, false], outside: [null] },
  assigned: { inside: [true, false], outside: [null] },
  voices: { inside: [true, false], outside: [null] },
  everySeat: { inside: [true, false], outside: [null] },
  rotation: { inside: [1], outside: [null] },
  seed: { inside: [7], outside: [null] },
};

/** One row for every term of a room of the ball game. */
export const termRows = Object.fromEntries(
  rowsOf('Terms').map(([name, line]) => [name, { ...termValues[name]!, outcome: byRole(['stranger', 'study'], line) }]),
);
