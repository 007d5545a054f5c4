import { createHmac } from 'node:crypto';
import type { SignalBody } from 'threepoint-rooms/internal';
import { describe, expect, test } from 'vitest';
import { relayConfigurationFrom } from '../../src/relay/settings/relay-configuration';
import { forkServer, sharedServer } from '../server/server-child';
import { paperPlan } from '../study/model/studies';
import { studySeats } from '../study/server/running-studies';
import { tokenFor, until } from './running-relay';
import { guestOfTest, personOfTest, relayOfTest } from './until-finished';

const offer: SignalBody = { description: { type: 'offer', sdp: 'v=0\r\n' } };
const turnSecret = 'turn-kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';

/** A person over a real socket, and what their page has received about the room's voices. */
function talker(url: string, room: string, name: string) {
  const person = personOfTest(url, room, name);
  const heard: { readonly from: string; readonly body: SignalBody }[] = [];
  person.connection.voices.setListener({
    onSeatsChanged: () => undefined,
    onSignal: (from, body) => heard.push({ from, body }),
  });
  const voiceOf = (seat: number) => person.connection.room?.seats[seat]?.voice;
  return Object.assign(person, { heard, voiceOf });
}

async function refusals(url: string, reason: string): Promise<number> {
  const metrics = await (await fetch(`${url}/metrics`)).text();
  const lines = metrics.matchAll(/^threepoint_refusals_total\{.*reason="([\w-]+)".*\} (\d+)$/gm);
  return [...lines].reduce((sum, [, why, count]) => sum + (why === reason ? Number(count) : 0), 0);
}

const server = sharedServer({ THREEPOINT_EVENTS_PER_SECOND: '200' });

/** Two people on their seats, both among the voices. */
async function twoTalkers(room: string) {
  const ann = talker(server.url, room, 'Ann');
  await until('ann in', () => ann.connection.room !== null);
  const ben = talker(server.url, room, 'Ben');
  await until('ben in', () => ben.connection.room !== null);
  ann.connection.voices.setVoice({ session: 'annas-page', muted: true });
  ben.connection.voices.setVoice({ session: 'bens-page', muted: true });
  await until('both known', () => Boolean(ann.voiceOf(1) && ben.voiceOf(0)));
  return { ann, ben };
}

describe('the voices of a room', () => {
  test('are known seat by seat, to later guests too, and end with the seat', async () => {
    const { ann, ben } = await twoTalkers('known');
    ann.connection.voices.setVoice({ session: 'annas-page', muted: false });
    await until('ben to know', () => ben.voiceOf(0)?.muted === false);
    const cal = talker(server.url, 'known', 'Cal');
    await until('cal in', () => cal.connection.room !== null);
    expect([0, 1, 2].map((seat) => cal.voiceOf(seat))).toEqual([
      { session: 'annas-page', muted: false },
      { session: 'bens-page', muted: true },
      null,
    ]);
    ann.connection.leave();
    await until('ann gone', () => cal.connection.room?.seats[0] === null);
    ben.connection.voices.setVoice(null);
    await until('ben silent', () => cal.voiceOf(1) === null);
  });

  test('are signalled to the intended page under the session that the room knows its sender by', async () => {
    const { ann, ben } = await twoTalkers('signals');
    const cal = talker(server.url, 'signals', 'Cal');
    await until('cal in', () => cal.connection.room !== null);
    cal.connection.voices.setVoice({ session: 'cals-page', muted: true });
    await until('cal known', () => Boolean(ann.voiceOf(2)));
    ann.connection.voices.sendSignal('bens-page', offer);
    await until('ben to hear', () => ben.heard.length > 0);
    ben.connection.voices.sendSignal('annas-page', { description: { type: 'answer', sdp: 'v=0\r\n' } });
    await until('ann to hear', () => ann.heard.length > 0);
    expect(ben.heard).toEqual([{ from: 'annas-page', body: offer }]);
    expect(ann.heard).toEqual([{ from: 'bens-page', body: { description: { type: 'answer', sdp: 'v=0\r\n' } } }]);
    expect(cal.heard).toEqual([]);
  });

  test('a seat keeps its voice while a lost connection is awaited; returning pages declare their own', async () => {
    const { ann } = await twoTalkers('returning');
    const token = await tokenFor(server.url, 'returning');
    const raw = await guestOfTest(server.url, 'returning', token);
    raw.say({ type: 'voice', voice: { session: 'raws-page', muted: false } });
    await until('raw known', () => ann.voiceOf(2)?.session === 'raws-page');
    raw.socket.disconnect();
    await until('raw lost', () => ann.connection.room?.seats[2]?.presence === 'gone');
    expect(ann.voiceOf(2)).toEqual({ session: 'raws-page', muted: false });
    // After a reload the person's page knows of no voices.
    await guestOfTest(server.url, 'returning', token);
    await until('raw back', () => ann.connection.room?.seats[2]?.presence === 'here');
    expect(ann.voiceOf(2)).toBeNull();
  });

  test('go to no other room, no foreign page, and not to oneself', async () => {
    const { ann } = await twoTalkers('one');
    const { ann: other } = await twoTalkers('other');
    const dot = talker(server.url, 'one', 'Dot');
    await until('dot in', () => dot.connection.room !== null);
    const before = await refusals(server.url, 'no-receiver');
    // Ben is called so in both rooms.
    other.connection.voices.sendSignal('bens-page', offer);
    ann.connection.voices.sendSignal('annas-page', offer);
    ann.connection.voices.sendSignal('dots-page', offer);
    dot.connection.voices.sendSignal('bens-page', offer);
    await expect.poll(() => refusals(server.url, 'no-receiver')).toBe(before + 3);
    expect([...dot.heard, ...ann.heard]).toEqual([]);
  });

  test('have no place for the session of another seat', async () => {
    const { ann, ben } = await twoTalkers('forged');
    const before = await refusals(server.url, 'session-taken');
    ben.connection.voices.setVoice({ session: 'annas-page', muted: false });
    await expect.poll(() => refusals(server.url, 'session-taken')).toBe(before + 1);
    expect(ann.voiceOf(1)).toEqual({ session: 'bens-page', muted: true });
    // A newcomer who asks for it while joining sits there without a voice.
    const cal = await guestOfTest(server.url, 'forged');
    cal.say({ type: 'voice', voice: { session: 'bens-page', muted: false } });
    await expect.poll(() => refusals(server.url, 'session-taken')).toBe(before + 2);
  });

  test('a signal too long or with its own seat is bad; the third ends the connection', async () => {
    const guest = await guestOfTest(server.url, 'bad');
    guest.say({ type: 'signal', to: 'bens-page', body: { description: { type: 'offer', sdp: 'v'.repeat(3300) } } });
    guest.say({ type: 'signal', to: 'bens-page', from: 'annas-page', body: offer });
    guest.say({ type: 'signal', to: 1, body: offer });
    await until('the end', () => guest.closedAt !== null);
    expect(guest.heard.at(-1)).toEqual({ type: 'farewell', reason: 'misbehaved' });
  });

  test('a flood of signals ends with its sender; the budget arrived, and the room goes on', async () => {
    const { ben } = await twoTalkers('flood');
    const flooding = await guestOfTest(server.url, 'flood');
    flooding.say({ type: 'voice', voice: { session: 'floods-page', muted: true } });
    await until('it is among them', () => ben.voiceOf(2) !== null);
    for (let i = 0; i < 400; i++) flooding.say({ type: 'signal', to: 'bens-page', body: offer });
    await until('the end', () => flooding.closedAt !== null);
    await until('what was within the budget', () => ben.heard.length >= 80);
    expect(ben.heard.length).toBeLessThan(400);
    expect(ben.connection.status.phase).toBe('joined');
  });

  test('a page that connects to five others at once is within its budget', async () => {
    const { ann, ben } = await twoTalkers('busy');
    for (let i = 0; i < 70; i++) ann.connection.voices.sendSignal('bens-page', offer);
    await until('all of them', () => ben.heard.length === 70);
  });
});

describe('a server without voices', () => {
  test('says so, and refuses to take part', async () => {
    const silent = await forkServer({ THREEPOINT_VOICES: 'off' });
    const ann = talker(silent.url, 'silent', 'Ann');
    await until('ann in', () => ann.connection.room !== null);
    ann.connection.voices.setVoice({ session: 'annas-page', muted: false });
    await expect.poll(() => refusals(silent.url, 'no-voices')).toBe(1);
    expect(ann.voiceOf(0)).toBeNull();
    const headers = { authorization: `Bearer ${await ann.pass.token(false)}` };
    const answer = await fetch(`${silent.url}/api/voices?room=silent`, { headers });
    expect(await answer.json()).toEqual({ voices: false, iceServers: [], ttlSeconds: null });
  });

  test('a room with more seats than a page can have connections has none either', async () => {
    const relay = await relayOfTest();
    const guest = await guestOfTest(relay.url, 'counting');
    guest.say({ type: 'voice', voice: { session: 'raws-page', muted: true } });
    await expect.poll(() => refusals(relay.url, 'no-voices')).toBe(1);
  });

  test('the room of a study has none, even for a page that joins with one', async () => {
    const seat = await studySeats.sign(paperPlan(), 'P01', { step: 'ball/1/trial-1', run: 1 }, false);
    const answer = await fetch(`${server.url}/api/voices?room=${seat.room}`, {
      headers: { authorization: `Bearer ${seat.token}` },
    });
    expect(await answer.json()).toEqual({ voices: false, iceServers: [], ttlSeconds: null });
  });
});

describe('the way from page to page', () => {
  test('leads over the environment’s servers; a pass to TURN lasts four hours without a name', async () => {
    const relayed = await forkServer({
      THREEPOINT_STUN: 'stun:stun.example.org:3478',
      THREEPOINT_TURN: 'turn:turn.example.org:3478?transport=udp, turns:turn.example.org:5349',
      THREEPOINT_TURN_SECRET: turnSecret,
    });
    const headers = { authorization: `Bearer ${await tokenFor(relayed.url, 'far')}` };
    const { voices, iceServers } = await (await fetch(`${relayed.url}/api/voices?room=far`, { headers })).json();
    expect(voices).toBe(true);
    const [stun, turn] = iceServers;
    expect(stun).toEqual({ urls: ['stun:stun.example.org:3478'] });
    expect(turn.urls).toEqual(['turn:turn.example.org:3478?transport=udp', 'turns:turn.example.org:5349']);
    const [, until, alias] = /^(\d+):([0-9a-f]{12})$/.exec(turn.username) ?? [];
    expect(Number(until) - Date.now() / 1000).toBeGreaterThan(4 * 3600 - 60);
    expect(alias).toBeDefined();
    expect(turn.credential).toBe(createHmac('sha1', turnSecret).update(turn.username).digest('base64'));
  });

  test.each([
    [{ THREEPOINT_VOICES: 'maybe' }, /THREEPOINT_VOICES must be on or off, not "maybe"/],
    [{ THREEPOINT_STUN: 'https://stun.example.org' }, /THREEPOINT_STUN must list addresses such as stun:.*not "https:/],
    [{ THREEPOINT_TURN: 'turn:here:3478?transport=smoke' }, /THREEPOINT_TURN must list addresses such as turn:.*smoke/],
    [{ THREEPOINT_TURN: 'turn:here:3478' }, /THREEPOINT_TURN needs THREEPOINT_TURN_SECRET with .* it has 0/],
  ])('%j is refused in a sentence', (environment, sentence) => {
    expect(() => relayConfigurationFrom(environment)).toThrow(sentence);
  });
});
