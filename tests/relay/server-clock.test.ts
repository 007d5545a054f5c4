import { expect, onTestFinished, test } from 'vitest';
import { reportFigures } from '../reliability/report-figures';
import { fists, holding, opening, releaseOf } from '../rooms/client/people';
import { forkServer } from '../server/server-child';
import { experimenterToken } from '../server/started-server';
import { completed, paperPlan } from '../study/model/studies';
import { asSent } from '../study/server/stored-studies';
import { arrive, tokenFor, until } from './running-relay';
import { createSlowWay } from './slow-way';

const hour = 3600;

test('a match goes on through an hour’s change of the server’s clock, and seats survive reconnection', {
  tags: ['full'],
}, async () => {
  const server = await forkServer();
  const way = await createSlowWay(server.port);
  onTestFinished(() => way.close());
  const people = ['Ann', 'Ben', 'Cal'].map((name, i) => arrive(i === 0 ? way.url : server.url, 'clock', name));
  onTestFinished(() => {
    for (const person of people) person.stop();
  });
  const [ann] = people as [(typeof people)[number], ...typeof people];
  const joined = () => people.filter(({ connection }) => connection.status.phase === 'joined').length;
  await until('all seated', () => people.every(({ connection }) => connection.room?.seats.every(Boolean)));
  for (const person of people) {
    person.place(person.seat === 2 ? holding(opening) : fists(releaseOf(person.seat)));
    person.connection.setReady(true);
  }
  await until('the match running', () => people.every(({ match }) => match.phase === 'running'));
  const { seat } = ann;
  for (const ahead of [hour, -hour]) {
    await server.setClock(ahead);
    expect(await tokenFor(server.url, 'clock')).toMatch(/^[\w-]+\.[\w-]+\.[\w-]+$/);
    const welcomes = ann.news.filter((word) => word === 'welcome').length;
    way.cut();
    await until('Ann to notice', () => ann.connection.status.phase === 'reconnecting');
    way.reopen();
    await until('Ann to be welcomed again', () => ann.news.filter((word) => word === 'welcome').length > welcomes);
    await until('Ann to be back', () => ann.connection.status.phase === 'joined');
    expect(ann.seat).toBe(seat);
    for (const { poses } of people) poses.length = 0;
    await until('all to see each other again', () => people.every(({ poses }) => poses.length > 0));
  }
  expect(joined()).toBe(3);
  expect(people.map(({ match }) => match.phase)).toEqual(['running', 'running', 'running']);
  expect(ann.connection.room?.voidedRounds).toBe(0);
  reportFigures('server-clock', {
    'players gone': people.length - joined(),
    'rounds void': ann.connection.room?.voidedRounds ?? 1,
  });
});

test('a study goes on through an hour’s change of the server’s clock: all accepted, in order', {
  tags: ['full'],
}, async () => {
  const server = await forkServer();
  const ask = async (method: string, path: string, token: string | null, json?: unknown) => {
    const response = await fetch(`${server.url}/api/studies${path}`, {
      method,
      headers: { 'content-type': 'application/json', ...(token && { authorization: `Bearer ${token}` }) },
      ...(json !== undefined && { body: JSON.stringify(json) }),
    });
    expect(response.ok, `${method} ${path}: ${response.status}`).toBe(true);
    // biome-ignore lint/suspicious/noExplicitAny: reason: an answer over HTTP has no type; the expectations state it
    return (response.status === 204 ? null : await response.json()) as any;
  };
  const own = '/paper/participants/P01';
  await ask('POST', '', experimenterToken, { plan: paperPlan(), simulated: false });
  const { token } = await ask('POST', `${own}/claim`, experimenterToken, {});
  const all = completed();
  const third = Math.ceil(all.length / 3);
  let refused = all.length;
  for (const [i, ahead] of [0, hour, -hour].entries()) {
    await server.setClock(ahead);
    const records = all.slice(i * third, (i + 1) * third);
    const { acknowledged } = await ask('POST', `${own}/records`, token, { records });
    expect(acknowledged).toEqual(records.map(({ id }) => id));
    refused -= acknowledged.length;
    await ask('POST', `${own}/commands`, experimenterToken, { type: i === 1 ? 'pause' : 'resume' });
  }
  const { records } = await ask('GET', `${own}/records`, token);
  expect(records.map(asSent)).toEqual(all);
  const { commands } = await ask('GET', `${own}/commands?after=0`, token);
  expect(commands.map(({ command }: { command: { type: string } }) => command.type)).toEqual([
    'resume',
    'pause',
    'resume',
  ]);
  reportFigures('server-clock', { 'records refused': refused });
});
