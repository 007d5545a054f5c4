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

/** Statuses of a well-formed request, by who sends it. */
export interface HttpRow {
  readonly gives: string;
  readonly json?: 'plan' | 'records' | 'progress' | 'motion' | 'seat' | Readonly<Record<string, unknown>>;
  /** Behind the path. */
  readonly query?: string;
  readonly status: Readonly<Record<HttpRole, number>>;
  /** A secret of this route alone, and the status that it gets. */
  readonly also?: {
    readonly who: 'invited' | 'withdrawing' | 'admin' | 'this machine' | 'player';
    readonly status: number;
  };
}

const shut = { otherSite: 403, pointedHere: 421 } as const;
const forAll = (status: number): HttpRow['status'] => ({
  stranger: status,
  network: status,
  ...shut,
  participant: status,
  otherParticipant: status,
  experimenter: status,
});
/** Read by pages of other sites too, without their seeing the answer. */
const readable = (status: number): HttpRow['status'] => ({ ...forAll(status), otherSite: status });
const forExperimenter = (status: number): HttpRow['status'] => ({ ...forAll(401), experimenter: status });
const forParticipant = (status: number): HttpRow['status'] => ({ ...forExperimenter(status), participant: status });

const study = '/api/studies/:study';
const place = `${study}/participants/:participant`;

/** One row for every route of the server: a route without one fails tests/server/access.test.ts. */
export const httpRows: Readonly<Record<string, HttpRow>> = {
  'GET /': { gives: 'the page and its files', status: readable(200) },
  'GET /healthz': { gives: 'health and the number of players', status: readable(200) },
  'GET /metrics': {
    gives: 'counts of the relay',
    status: readable(403),
    also: { who: 'this machine', status: 200 },
  },
  'GET /relay': { gives: 'nothing without an upgrade', status: readable(426) },
  'GET /api/rooms': { gives: 'open rooms', status: forAll(200) },
  'POST /api/rooms/match': { gives: 'the name of an open room', json: { kind: 'ball' }, status: forAll(200) },
  'POST /api/rooms/new': { gives: 'the name of a new room', json: { kind: 'ball' }, status: forAll(200) },
  'POST /api/rooms/token': {
    gives: 'a pass to an open room',
    json: { room: 'meadow', kind: 'ball' },
    status: forAll(200),
  },
  'POST /api/rooms/end': {
    gives: 'the end of any room',
    json: { room: 'meadow' },
    status: forAll(403),
    also: { who: 'admin', status: 200 },
  },
  'GET /api/avatars': {
    gives: 'which avatars of the room may be stored',
    query: '?room=meadow',
    status: forAll(401),
    also: { who: 'player', status: 200 },
  },
  'GET /api/avatars/:hash': {
    gives: 'an avatar’s file',
    query: '?room=meadow',
    status: forAll(401),
    also: { who: 'player', status: 200 },
  },
  'PUT /api/avatars/:hash': {
    gives: 'one’s own avatar to the room',
    query: '?room=meadow',
    status: forAll(401),
    also: { who: 'player', status: 204 },
  },
  'GET /api/voices': {
    gives: 'whether the room has voices, and their servers',
    query: '?room=meadow',
    status: forAll(401),
    also: { who: 'player', status: 200 },
  },
  'GET /api/studies': { gives: 'the list of studies', status: forExperimenter(200) },
  'DELETE /api/studies/:study': { gives: 'the deletion of a simulated study', status: forExperimenter(403) },
  'POST /api/studies': { gives: 'a new study', json: 'plan', status: forExperimenter(201) },
  [`GET ${study}`]: { gives: 'title and consent text', status: forAll(200) },
  [`GET ${study}/records`]: { gives: 'everything recorded', status: forExperimenter(200) },
  [`GET ${study}/receipts`]: { gives: 'receipts of deletions', status: forExperimenter(200) },
  [`GET ${study}/export`]: { gives: 'everything, as a zip file', status: forExperimenter(200) },
  [`GET ${study}/participants`]: { gives: 'progress and invitations of all', status: forExperimenter(200) },
  [`POST ${study}/withdraw`]: {
    gives: 'deletion under a withdrawal code',
    json: { code: 'ZZZZ-ZZZZ-ZZZZ-ZZZZ' },
    status: forAll(404),
    also: { who: 'withdrawing', status: 200 },
  },
  [`POST ${place}/claim`]: {
    gives: 'a free place',
    json: {},
    status: { ...forAll(403), experimenter: 201 },
    also: { who: 'invited', status: 201 },
  },
  [`POST ${place}/invitation`]: { gives: 'a new invitation to the place', status: forExperimenter(204) },
  [`POST ${place}/release`]: { gives: 'the place to another device', status: forExperimenter(204) },
  [`POST ${place}/records`]: { gives: 'records to the store', json: 'records', status: forParticipant(200) },
  [`GET ${place}/records`]: { gives: 'the participant’s records', status: forParticipant(200) },
  [`PUT ${place}/progress`]: { gives: 'the step to the store', json: 'progress', status: forParticipant(204) },
  [`GET ${place}/progress`]: { gives: 'the participant’s step', status: forParticipant(200) },
  [`GET ${place}/commands`]: { gives: 'the experimenter’s commands', status: forParticipant(200) },
  [`POST ${place}/commands`]: {
    gives: 'a command to the participant’s page',
    json: { type: 'pause' },
    status: forExperimenter(201),
  },
  [`POST ${place}/remarks`]: { gives: 'a remark to the store', json: { text: 'tall' }, status: forExperimenter(201) },
  [`PUT ${place}/motion`]: {
    gives: 'tracked frames to the store',
    json: 'motion',
    query: '?trial=archery/1/trial-1',
    status: forParticipant(204),
  },
  [`POST ${place}/seat`]: {
    gives: 'a pass to the trial’s room, for an experimenter to watch',
    json: 'seat',
    status: forParticipant(200),
  },
  [`GET ${place}/export`]: { gives: 'the participant’s data, as a zip file', status: forParticipant(200) },
  [`DELETE ${place}`]: { gives: 'the deletion of the participant’s data', status: forExperimenter(200) },
};

/** Who speaks to a room. */
export const socketRoles = {
  player: 'the holder of a pass, on a seat of a room that is open to all',
  spectator: 'the holder of such a pass, watching',
  participant: 'a participant in the room of their trial',
  experimenter: 'an experimenter, watching there',
} as const;
export type SocketRole = keyof typeof socketRoles;

/** What becomes of it: taken; refused, with the room's reason; ends the connection. */
export type Outcome = 'taken' | 'no-seat' | 'not-pausable' | 'assigned' | 'no-voices' | 'ends';

export interface SocketRow {
  readonly gives: string;
  readonly outcome: Readonly<Record<SocketRole, Outcome>>;
}

const all = (outcome: Outcome): SocketRow['outcome'] => ({
  player: outcome,
  spectator: outcome,
  participant: outcome,
  experimenter: outcome,
});
const inVoices: SocketRow['outcome'] = { ...all('no-voices'), player: 'taken', spectator: 'no-seat' };
const seated: SocketRow['outcome'] = { ...all('taken'), spectator: 'no-seat', experimenter: 'no-seat' };

/** One row for every message of a client, and for what is none. */
export const socketRows: Readonly<Record<ReturnType<typeof joinMessage>['type'] | 'pose' | 'unknown', SocketRow>> = {
  join: { gives: 'a free seat; in a trial the own one', outcome: all('taken') },
  pose: { gives: 'the own body to the others; spectators show none', outcome: all('taken') },
  ready: { gives: 'the start of the match', outcome: seated },
  away: { gives: 'that the player is away', outcome: all('taken') },
  sit: {
    gives: 'another seat that is free',
    outcome: { ...all('taken'), participant: 'assigned', experimenter: 'assigned' },
  },
  calibration: { gives: 'the own measures', outcome: all('taken') },
  wear: {
    gives: 'another avatar to the own seat',
    outcome: { ...all('taken'), participant: 'assigned', experimenter: 'assigned' },
  },
  voice: { gives: 'the room’s voices', outcome: inVoices },
  signal: { gives: 'what connects two pages’ voices', outcome: inVoices },
  pause: { gives: 'a paused clock', outcome: { ...seated, player: 'not-pausable' } },
  ping: { gives: 'the room’s time', outcome: all('taken') },
  leave: { gives: 'the own seat back', outcome: all('taken') },
  action: { gives: 'what the hands do, and other roles with the next match, judged by the rules', outcome: seated },
  unknown: { gives: 'nothing', outcome: all('ends') },
};

/** Who sets the terms of a room. */
export const termRoles = {
  stranger: 'anyone, by asking for a pass to a room that is open to all',
  study: 'the study service, which signs the seats of a trial',
} as const;
export type TermRole = keyof typeof termRoles;

/** A term of a room of the ball game, with values inside and outside its range. */
export interface TermRow {
  readonly gives: string;
  readonly inside: readonly unknown[];
  readonly outside: readonly unknown[];
  readonly outcome: Readonly<Record<TermRole, 'taken' | 'refused'>>;
}

const option = (gives: string, ...inside: readonly unknown[]): TermRow => ({
  gives,
  inside,
  outside: [null],
  outcome: { stranger: 'refused', study: 'refused' },
});

/** One row for every term of a room of the ball game, and for the other options of its room and its rules. */
export const termRows: Readonly<Record<string, TermRow>> = {
  seconds: {
    gives: 'the length of a round, 1 to 3600 s',
    inside: [1, 45.5, 3600],
    outside: [0, 3600.5, -90, '90', null, [90]],
    outcome: { stranger: 'taken', study: 'taken' },
  },
  balls: {
    gives: 'the number of balls, 1 to 20',
    inside: [1, 20],
    outside: [0, 21, 2.5, '6', null],
    outcome: { stranger: 'taken', study: 'refused' },
  },
  pausable: option('a clock that players may pause', true, false),
  assigned: option('seats that cannot be changed', true, false),
  voices: option('voices', true, false),
  everySeat: option('a match only of three', true, false),
  rotation: option('other roles at the start', 1),
  seed: option('another order of the balls', 7),
};

/** Returns a list of rows for each outcome, in the order of its first row. */
function lists(rows: readonly { readonly name: string; readonly gives: string; readonly outcome: string }[]): string {
  const groups = new Map<string, string[]>();
  for (const { name, gives, outcome } of rows)
    groups.set(outcome, [...(groups.get(outcome) ?? []), `- \`${name}\`: ${gives}`]);
  return [...groups].map(([outcome, lines]) => `${outcome}\n\n${lines.join('\n')}`).join('\n\n');
}

/** Returns the roles by outcome. The most frequent outcome stands last, for “others” or “all”. */
function byOutcome<Role extends string>(roles: readonly Role[], outcomeOf: (role: Role) => string): string {
  const groups = new Map<string, Role[]>();
  for (const role of roles) groups.set(outcomeOf(role), [...(groups.get(outcomeOf(role)) ?? []), role]);
  const ordered = [...groups].toSorted(([, a], [, b]) => a.length - b.length);
  const usual = ordered.pop()?.[0];
  const named = ordered.map(([outcome, some]) => `${some.join(', ')}: ${outcome}`);
  return [...named, `${named.length ? 'others' : 'all'}: ${usual}`].join('; ');
}

const emphasised = (status: number): string => (status < 300 ? `**${status}**` : `${status}`);

/** Returns the answers to a request, without those that every page of another site or name gets. */
function answers({ status, also }: HttpRow): string {
  const usual: Readonly<Record<string, number>> = shut;
  const roles = (Object.keys(httpRoles) as HttpRole[]).filter((role) => status[role] !== usual[role]);
  const listed = byOutcome(roles, (role) => emphasised(status[role]));
  const others = roles.includes('otherSite') ? `${listed}, other sites too` : listed;
  return also ? `${also.who}: ${emphasised(also.status)}; ${others}` : others;
}

/** Returns the lists that docs/security.md has between its marks. */
export function accessLists(): string {
  const http = Object.entries(httpRows).map(([name, row]) => ({ name, gives: row.gives, outcome: answers(row) }));
  const sockets = Object.entries(socketRows).map(([name, { gives, outcome }]) => ({
    name,
    gives,
    outcome: byOutcome(Object.keys(socketRoles) as SocketRole[], (role) => outcome[role]),
  }));
  const terms = Object.entries(termRows).map(([name, { gives, outcome }]) => ({
    name,
    gives,
    outcome: byOutcome(Object.keys(termRoles) as TermRole[], (role) => outcome[role]),
  }));
  return [`### Requests\n\n${lists(http)}`, `### Messages\n\n${lists(sockets)}`, `### Terms\n\n${lists(terms)}`].join(
    '\n\n',
  );
}

export const marks = ['<!-- written by scripts/security-table.ts -->', '<!-- up to here -->'] as const;

/** The page with its lists as they are now; throws where it has no marks. */
export function withLists(page: string): string {
  const [before, after] = [page.indexOf(marks[0]), page.indexOf(marks[1])];
  if (before < 0 || after < before) throw new Error('docs/security.md lacks the marks between which its lists stand');
  return `${page.slice(0, before)}${marks[0]}\n\n${accessLists()}\n\n${page.slice(after)}`;
}
