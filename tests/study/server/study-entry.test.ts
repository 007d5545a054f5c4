import { connect } from 'node:net';
import { describe, expect, test } from 'vitest';
import { participantsOf } from '../../../src/study/model/plan/plan';
import { openPlacesPerHour } from '../../../src/study/server/routes/guard';
import { reportFigures } from '../../reliability/report-figures';
import { paperPlan } from '../model/studies';
import { type Asked, experimenter, servedPaperStudy } from './running-studies';

const claimPath = (participant: string) => `/api/studies/paper/participants/${participant}/claim`;
const people = participantsOf(paperPlan());
type Server = Awaited<ReturnType<typeof servedPaperStudy>>;
const taken = ({ store }: Server) => store.overview('paper', 0).filter(({ claimed }) => claimed).length;

/** Returns a wrong invitation or code, which differs for each number. */
const guessed = (number: number) => `ZZZZ-ZZZZ-ZZZZ-${String(number).padStart(4, '0')}`;

describe('a place in a study', () => {
  test('is taken by the invitation in the participant’s link, however it is typed', async () => {
    const { ask, invited } = await servedPaperStudy();
    const { invitation } = invited('P01');
    expect(invitation).toMatch(/^([0-9A-HJKMNP-TV-Z]{4}-){3}[0-9A-HJKMNP-TV-Z]{4}$/);
    const typed = (invitation as string).toLowerCase().replaceAll('-', ' ');
    expect((await ask('POST', claimPath('P01'), { json: { invitation: typed } })).status).toBe(201);
  });

  test('is not taken without one, nor by that of another participant', async () => {
    const server = await servedPaperStudy();
    const { ask, invited } = server;
    const { status, json } = await ask('POST', claimPath('P01'), { json: {} });
    expect([status, json.error]).toEqual([403, 'P01 needs an invitation, which is in the participant’s link']);
    expect((await ask('POST', claimPath('P01'), { json: invited('P02') })).status).toBe(403);
    expect(taken(server)).toBe(0);
  });

  test('is not taken by a page of another site, even one that knows the invitation', async () => {
    const server = await servedPaperStudy();
    const { ask, origin, invited } = server;
    const json = 'application/json';
    const body = JSON.stringify(invited('P01'));
    const attempts: Record<string, string>[] = [
      { origin: 'http://evil.example', 'content-type': json },
      { origin: origin.replace('http:', 'https:'), 'content-type': json },
      { origin: 'null', 'content-type': json },
      { 'sec-fetch-site': 'cross-site', 'content-type': json },
      // Forms can send these types without a preflight request.
      { origin: 'http://evil.example', 'content-type': 'text/plain' },
      { origin: 'http://evil.example', 'content-type': 'application/x-www-form-urlencoded' },
      { 'content-type': 'text/plain' },
    ];
    let refused = 0;
    for (const headers of attempts) {
      const { status } = await ask('POST', claimPath('P01'), { raw: { method: 'POST', headers, body } });
      if (status === 403 || status === 415) refused += 1;
    }
    expect(refused).toBe(attempts.length);
    expect(taken(server)).toBe(0);
    reportFigures('other-sites', { 'claims of other sites refused': `${refused} of ${attempts.length}` });
  });

  test('is not taken by a loop over all of them', async () => {
    const server = await servedPaperStudy();
    for (let round = 0; round < 20; round++) {
      for (const [index, participant] of people.entries()) {
        await server.ask('POST', claimPath(participant), { json: { invitation: guessed(round * 100 + index) } });
      }
    }
    expect(taken(server)).toBe(0);
    reportFigures('study-places', { 'places taken by 300 claims in a loop': `${taken(server)} of ${people.length}` });
    // Invited participants still get their places.
    const later = await server.ask('POST', claimPath('P07'), { json: server.invited('P07'), from: '198.51.100.7' });
    expect(later.status).toBe(201);
  });

  test('has a new invitation once the experimenter clears it, and its old one once released', async () => {
    const { ask, invited, claim, store } = await servedPaperStudy();
    const before = invited('P01');
    await claim('P01');
    store.places.release('paper', 'P01');
    expect(invited('P01')).toEqual(before);
    await ask('DELETE', '/api/studies/paper/participants/P01', { token: experimenter });
    expect((await ask('POST', claimPath('P01'), { json: before })).status).toBe(403);
    expect((await ask('POST', claimPath('P01'), { json: invited('P01') })).status).toBe(201);
  });

  test('gets another link for a lost one, which then opens nothing', async () => {
    const { ask, invited } = await servedPaperStudy();
    const lost = invited('P01');
    const untouched = invited('P02');
    const path = '/api/studies/paper/participants/P01/invitation';
    expect((await ask('POST', path, { token: experimenter })).status).toBe(204);
    expect((await ask('POST', claimPath('P01'), { json: lost })).status).toBe(403);
    expect((await ask('POST', claimPath('P01'), { json: invited('P01') })).status).toBe(201);
    expect(invited('P02')).toEqual(untouched);
  });

  test('is the experimenter’s to take without one: a program takes part in a simulated study', async () => {
    const { ask } = await servedPaperStudy();
    expect((await ask('POST', claimPath('P01'), { json: {}, token: experimenter })).status).toBe(201);
    expect((await ask('POST', claimPath('P02'), { json: {}, token: `${experimenter}x` })).status).toBe(403);
  });

  test('is taken by the one invitation of an open study, a few an hour per address', async () => {
    const server = await servedPaperStudy({ entry: 'open' });
    const { ask, invited } = server;
    expect(new Set(people.map((participant) => invited(participant).invitation)).size).toBe(1);
    const claimed = async (participant: string, from: string) =>
      (await ask('POST', claimPath(participant), { json: invited('P01'), from })).status;
    const statuses: number[] = [];
    for (const participant of people) statuses.push(await claimed(participant, '203.0.113.7'));
    expect(statuses.filter((status) => status === 201)).toHaveLength(openPlacesPerHour);
    expect(new Set(statuses.slice(openPlacesPerHour))).toEqual(new Set([429]));
    expect(await claimed('P15', '203.0.113.8')).toBe(201);
    reportFigures('study-places', {
      'places of an open study taken from one address': `${openPlacesPerHour} of ${people.length} within an hour`,
    });
  });
});

test('a claim of a taken place leaves the address its places of an open study', async () => {
  const server = await servedPaperStudy({ entry: 'open' });
  const from = '203.0.113.7';
  const claimed = async (participant: string) =>
    (await server.ask('POST', claimPath(participant), { json: server.invited(participant), from })).status;
  expect(await claimed('P01')).toBe(201);
  for (let again = 0; again < openPlacesPerHour; again++) expect(await claimed('P01')).toBe(409);
  const others = people.slice(1, 1 + openPlacesPerHour);
  const statuses = await Promise.all(others.map(claimed));
  expect(statuses.toSorted()).toEqual([...others.slice(1).map(() => 201), 429]);
});

describe('3000 guesses from one address', () => {
  const from = '203.0.113.9';
  const guesses = Array.from({ length: 3000 }, (_, number) => number);
  /** The most attempts within the time limit of a test, 120 s: six at once, then one after 1, 2, 4, … 64 s. */
  const maxAttempts = 13;

  async function guessAll(server: Server, what: string, asked: (number: number) => [string, string, Asked]) {
    const statuses = new Map<number, number>();
    for (let first = 0; first < guesses.length; first += 60) {
      const answers = guesses.slice(first, first + 60).map((number) => {
        const [method, path, options] = asked(number);
        return server.ask(method, path, { ...options, from });
      });
      for (const { status, headers } of await Promise.all(answers)) {
        statuses.set(status, (statuses.get(status) ?? 0) + 1);
        if (status === 429) expect(Number(headers.get('retry-after'))).toBeGreaterThan(0);
      }
    }
    const lookedAt = guesses.length - (statuses.get(429) ?? 0);
    expect(lookedAt).toBeGreaterThanOrEqual(6);
    expect(lookedAt).toBeLessThanOrEqual(maxAttempts);
    expect(server.failedAttempts()).toHaveLength(lookedAt);
    expect(JSON.stringify(server.failedAttempts())).not.toMatch(/ZZZZ|guess-/);
    reportFigures('guessing', { [what]: `${lookedAt} of ${guesses.length} looked at` });
    return statuses;
  }

  test('for the experimenter’s token are hardly checked, and the experimenter goes on working', {
    tags: ['full'],
  }, async () => {
    const server = await servedPaperStudy();
    const list = (token: string) => server.ask('GET', '/api/studies', { token, from });
    expect((await list(experimenter)).status).toBe(200);
    await guessAll(server, 'tokens', (number) => [
      'GET',
      ['/api/studies', '/api/studies/paper/records', '/api/studies/other/export'][number % 3] as string,
      { token: `guess-${number}` },
    ]);
    expect((await list(experimenter)).status).toBe(200);
    const { status } = await server.ask('GET', '/api/studies', { token: experimenter, from: '198.51.100.1' });
    expect(status).toBe(200);
  });

  test('for a withdrawal code are hardly checked, and the records stay', { tags: ['full'] }, async () => {
    const server = await servedPaperStudy();
    const { json } = await server.ask('POST', claimPath('P01'), { json: server.invited('P01') });
    const path = '/api/studies/paper/withdraw';
    await guessAll(server, 'withdrawal codes', (number) => ['POST', path, { json: { code: guessed(number) } }]);
    const withdrawn = await server.ask('POST', path, { json: { code: json.withdrawalCode }, from: '198.51.100.1' });
    expect(withdrawn.json).toMatchObject({ participant: 'P01', reason: 'withdrawn' });
  });

  test('for an invitation, all in one packet, are hardly checked', { tags: ['full'] }, async () => {
    const server = await servedPaperStudy();
    const { port } = new URL(server.origin);
    const requests = guesses
      .map((number) => {
        const body = JSON.stringify({ invitation: guessed(number) });
        return `POST ${claimPath('P01')} HTTP/1.1\r\nhost: localhost\r\ncontent-type: application/json\r\ncontent-length: ${body.length}\r\n\r\n${body}`;
      })
      .join('');
    const answered = await new Promise<string>((resolve) => {
      let heard = '';
      const socket = connect(Number(port), '127.0.0.1', () => socket.write(requests));
      socket.setEncoding('latin1').on('data', (text) => {
        heard += text;
        if (heard.split('HTTP/1.1 ').length > guesses.length) socket.destroy();
      });
      socket.on('close', () => resolve(heard));
    });
    const answers = answered.match(/HTTP\/1\.1 \d{3}/g) ?? [];
    expect(answers.filter((line) => line.endsWith('429')).length).toBeGreaterThanOrEqual(answers.length - 10);
    expect(server.failedAttempts().length).toBeLessThanOrEqual(10);
    expect(taken(server)).toBe(0);
    reportFigures('guessing', { 'invitations in one packet': `${server.failedAttempts().length} of 3000 looked at` });
  });
});
