import { readFile } from 'node:fs/promises';
import { loadAvatar } from 'threepoint/three';
import { expect, test, vi } from 'vitest';
import { RemoteBodies } from '../../../src/rooms/drawing/remote-bodies';
import { PoseSender } from '../../../src/rooms/peers/pose-sender';
import { solvedActor } from './solved-actor';

test('a body whose peer is silent for 30 s is removed, as by the transport', async () => {
  const avatar = await loadAvatar(await readFile('public/avatars/mannequin.vrm'));
  const dispose = vi.spyOn(avatar, 'dispose');
  const forgotten: string[] = [];
  const others = new RemoteBodies({ avatar: async () => avatar, onPeerTimeout: (peer) => forgotten.push(peer) });
  const actor = solvedActor();
  let now = 0;
  const sender = new PoseSender((bytes) => others.receive('ada', bytes, now), { name: 'Ada' });
  const frame = async () => {
    now += 1000 / 60;
    actor.moveTo(now);
    sender.update(now, actor);
    others.update(now);
    await Promise.resolve();
  };
  await vi.waitFor(async () => {
    await frame();
    expect(others.object.children.filter(({ visible }) => visible)).toHaveLength(1);
  });
  others.update(now + 29_000);
  expect(others.object.children).toHaveLength(1);
  others.update(now + 31_000);
  expect(others.object.children).toHaveLength(0);
  expect(dispose).toHaveBeenCalledOnce();
  expect(forgotten).toEqual(['ada']);
});
