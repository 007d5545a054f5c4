import { expect, test } from 'vitest';
import { createActor } from '../../../src/page/emulator/actor';

test('the actor stands still while its viewer prefers reduced motion', () => {
  let reduced = true;
  const actor = createActor(() => reduced);
  const handAt = (time: number) => actor.frameAt(time).leftHand?.position;
  for (const time of [1, 3, 7]) expect(handAt(time)).toEqual(handAt(0));
  reduced = false;
  const start = handAt(8);
  expect(handAt(12)).not.toEqual(start);
});
