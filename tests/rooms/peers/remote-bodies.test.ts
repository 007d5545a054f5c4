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
  const others = new RemoteBodies({ avatar: async () => avatar });
  others.addEventListener('peertimeout', ({ peer }) => forgotten.push(peer));
  const actor = solvedActor();
  let now = 0;
  const sender = new PoseSender((bytes) => others.receive(now, 'ada', bytes), { name: 'Ada' });
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

/** A person who sends their pose and an avatar's reference, 60 times a second. */
function sends(others: RemoteBodies, peer: string) {
  const actor = solvedActor();
  let now = 0;
  let reference: string | null = null;
  const sender = new PoseSender((bytes) => others.receive(now, peer, bytes), { name: peer });
  return (timeMs: number, avatar: string) => {
    now = timeMs;
    actor.moveTo(now);
    if (avatar !== reference) sender.setAvatar(avatar);
    reference = avatar;
    sender.update(now, actor);
  };
}

test('an avatar that never arrives leaves its person the previous one, and holds up nobody else', async () => {
  const file = await readFile('public/avatars/mannequin.vrm');
  const requests: string[] = [];
  const disposed: string[] = [];
  const others = new RemoteBodies({
    async avatar(reference, peer) {
      const request = `${reference} of ${peer}`;
      requests.push(request);
      if (reference === 'endless') return new Promise(() => undefined);
      const avatar = await loadAvatar(file);
      const dispose = vi.spyOn(avatar, 'dispose');
      dispose.mockImplementation(() => void disposed.push(request));
      return avatar;
    },
  });
  const [ada, ben] = [sends(others, 'ada'), sends(others, 'ben')];
  let now = 0;
  const drawn = async (count: number, adas: string, bens: string | null) => {
    for (let i = 0; i < 30; i++) {
      now += 1000 / 60;
      ada(now, adas);
      if (bens) ben(now, bens);
      others.update(now);
      await new Promise((resolve) => setTimeout(resolve));
    }
    expect(others.object.children.filter(({ visible }) => visible)).toHaveLength(count);
  };
  const until = (check: () => Promise<void>) => vi.waitFor(check, { timeout: 30_000 });
  await until(() => drawn(1, 'red', null));
  await until(async () => {
    await drawn(1, 'endless', null);
    expect(requests).toEqual(['red of ada', 'endless of ada']);
  });
  await until(() => drawn(2, 'endless', 'red'));
  await until(async () => {
    await drawn(2, 'endless', 'blue');
    expect(disposed).toEqual(['red of ben']);
  });
  expect(requests).toEqual(['red of ada', 'endless of ada', 'red of ben', 'blue of ben']);
  others.remove('ben');
  await drawn(1, 'endless', null);
  expect(disposed).toEqual(['red of ben', 'blue of ben']);
  others.dispose();
});
