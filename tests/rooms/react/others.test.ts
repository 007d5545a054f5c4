import { createElement, createRef } from 'react';
import { beforeEach, expect, onTestFinished, test } from 'vitest';
import { type JoinedRoom, joinRoom } from '../../../src/rooms/drawing/join-room';
import { RoomAvatars, type RoomAvatarsProps } from '../../../src/rooms/react/index';
import { servedRooms } from '../../relay/served-rooms';
import { openCanvas } from '../../threepoint/api/canvas';
import { stubFileFetch } from '../peers/file-fetch';
import { solvedActor } from '../peers/solved-actor';

beforeEach(stubFileFetch);

/** A server with rooms, and a component that joins one of them. */
async function opened() {
  const { rooms, url } = await servedRooms();
  const canvas = await openCanvas();
  const ref = createRef<JoinedRoom>();
  const options: RoomAvatarsProps = { url, name: 'Ann', body: solvedActor(), storage: null, ref };
  const show = (props: Partial<RoomAvatarsProps> = {}, strict = false) =>
    canvas.show(createElement(RoomAvatars, { ...options, ...props }), { strict });
  return { canvas, rooms, url, ref, show };
}

test('joined in StrictMode, a page has one place and one object in the scene', async () => {
  const { canvas, rooms, ref, show } = await opened();
  await show({}, true);
  await canvas.settle(() => ref.current);
  expect(canvas.children).toEqual([ref.current!.others.object]);
  expect(ref.current!.seat).toBe(0);
  await canvas.draw(3);
  expect([rooms.census.players, ref.current!.status.phase]).toEqual([1, 'joined']);
});

test('a room is left with the component, and for another name or room', async () => {
  const { canvas, url, ref, show } = await opened();
  const watcher = await joinRoom(url, { name: 'Eve', body: null, storage: null });
  onTestFinished(() => watcher.leave());
  const names = () => {
    watcher.update(performance.now());
    return watcher.others.people.filter(({ presence }) => presence === 'here').map(({ name }) => name);
  };
  await show();
  await canvas.settle(() => names().join() === 'Ann' && ref.current);
  const first = ref.current!;
  await show({ name: 'Anna' });
  await canvas.settle(() => names().join() === 'Anna');
  expect(first.status.phase).toBe('ended');
  await show({ name: 'Anna', room: 'lunch' });
  await canvas.settle(() => names().length === 0 && ref.current);
  await canvas.show(null);
  expect([ref.current, canvas.children]).toEqual([null, []]);
});

test('a component that is unmounted while it joins leaves the room that it has joined', async () => {
  const { canvas, rooms, ref, show } = await opened();
  await show();
  await canvas.show(null);
  await show();
  await canvas.settle(() => ref.current);
  await canvas.settle(() => rooms.census.players === 1);
  expect(canvas.errors).toEqual([]);
});

test('a room that cannot be joined is an error of the nearest boundary', async () => {
  const { canvas, show } = await opened();
  await show({ url: 'http://127.0.0.1:9' });
  await canvas.settle(() => canvas.errors.length > 0);
  expect(canvas.errors).toEqual([
    expect.stringMatching(/^The room "lobby" at http:\/\/127\.0\.0\.1:9 cannot be joined/),
  ]);
});
