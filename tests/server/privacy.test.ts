import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { DatabaseSync } from '@photostructure/sqlite';
import { expect, test } from 'vitest';
import { arrive, until } from '../relay/running-relay';
import { reportFigures } from '../reliability/report-figures';
import { fists, releaseOf } from '../rooms/client/people';
import { createTestRoom } from '../rooms/room/test-room';
import { completed, paperPlan } from '../study/model/studies';
import { opened } from '../study/server/stored-studies';
import { forkServer } from './server-child';

/** Every file below a directory, of any name. */
const filesIn = (directory: string): Buffer[] =>
  readdirSync(directory, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => readFileSync(join(entry.parentPath, entry.name)));

/** Fields that only a tracked pose or a body has. */
const motionFields = /"(leftHand|rightHand|localRotations|hipsPosition|orientation|frames)"\s*:\s*[[{]/;

test('a match over sockets and a study without motion consent leave no motion on disk', {
  tags: ['full'],
}, async () => {
  const server = await forkServer();
  const { directory } = server;
  const people = ['Ann', 'Ben'].map((name) => arrive(server.url, 'ball-privacy', name));
  await until('both are seated', () => people.every(({ connection }) => connection.room?.mySeat != null));
  const before = filesIn(directory).map(({ length }) => length);
  const heard = people.map(({ poses }) => poses.length);
  await until('each to have heard sixty more poses', () =>
    people.every(({ poses }, i) => poses.length > heard[i]! + 60),
  );
  expect(
    filesIn(directory).map(({ length }) => length),
    'playing writes nothing',
  ).toEqual(before);
  for (const person of people) person.stop();

  const file = join(directory, 'studies/studies.db');
  const { store } = opened(file);
  const now = 1_800_000_000;
  store.plans.add(paperPlan(), { simulated: false, at: now });
  store.records.store('paper', 'P01', completed(), now);
  const recording = '{"frames":[[1,{"leftHand":{"x":0.1234567}}]]}';
  expect(() => store.motion.store('paper', 'P01', 'archery/1/trial-1', recording, now)).toThrow('motion recording');
  store.close();

  const database = new DatabaseSync(file);
  const tables = database.prepare("SELECT name FROM sqlite_master WHERE type = 'table'").all() as { name: string }[];
  let rows = 0;
  for (const { name } of tables) {
    for (const row of database.prepare(`SELECT * FROM "${name}"`).all()) {
      rows += 1;
      expect(JSON.stringify(row), name).not.toMatch(/"leftHand\\?":\s*[[{]\\?"?(position|x)/);
      expect(
        Object.values(row as object).some(
          (value) => typeof value === 'string' && motionFields.test(value) && /0\.1234567/.test(value),
        ),
      ).toBe(false);
    }
  }
  database.close();
  expect(rows).toBeGreaterThan(10);
  const motion = filesIn(directory).filter((bytes) => bytes.includes('0.1234567')).length;
  expect(motion).toBe(0);
  reportFigures('privacy', {
    'written while playing': '0 bytes',
    'files with motion refused consent': `${motion}`,
    'rows read': rows,
  });
});

test('no code that carries poses knows a file or a database, so none writes to disk', () => {
  const sources = new URL('../../src/', import.meta.url);
  const carriers = ['rooms/room', 'rooms/protocol', 'relay'].flatMap((folder) =>
    readdirSync(new URL(`${folder}/`, sources), { encoding: 'utf8', recursive: true })
      // Avatars are files, which the server keeps as long as someone wears them.
      .filter((file) => file.endsWith('.ts') && !/^avatars[\\/]/.test(file))
      .map((file) => new URL(`${folder}/${file}`, sources)),
  );
  expect(carriers.length).toBeGreaterThan(15);
  const writers = carriers.filter((file) =>
    /node:fs|sqlite|study-(store|database)|node:child_process/.test(readFileSync(file, 'utf8')),
  );
  expect(writers.map(({ pathname }) => pathname)).toEqual([]);
  reportFigures('privacy', {
    'modules with poses that know a disk': `${writers.length} of ${carriers.length}`,
  });
});

test('a room hands out no pose that is older than two seconds', () => {
  const testRoom = createTestRoom();
  testRoom.begin();
  const at = testRoom.time;
  testRoom.send('ann', testRoom.packet(0, fists(releaseOf(0))));
  testRoom.pass(0.1, () => undefined);
  expect(testRoom.frames.length).toBeGreaterThan(0);
  testRoom.pass(2, () => undefined);
  const before = testRoom.frames.length;
  testRoom.pass(5, () => undefined);
  const late = testRoom.frames.length - before;
  expect(late).toBe(0);
  expect(testRoom.time).toBeGreaterThan(at + 7);
  const joined = testRoom.join('late');
  expect(JSON.stringify(joined)).not.toMatch(/"(localRotations|hipsPosition)"/);
  reportFigures('privacy', { 'poses handed out after 2 s': late });
});
