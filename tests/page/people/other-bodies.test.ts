import { TransientError } from 'threepoint/core';
import { expect, test } from 'vitest';
import { BuiltInBodies } from '../../../src/page/people/match/other-bodies';

test('a built-in body whose download failed is fetched again when it is needed again', async () => {
  let asked = 0;
  const bodies = new BuiltInBodies(new ArrayBuffer(0), () => {
    asked += 1;
    return Promise.reject(new TransientError('the network is gone'));
  });
  for (const attempt of [1, 2]) {
    await expect(bodies.load('woman')).rejects.toThrow('the network is gone');
    expect(asked).toBe(attempt);
  }
});
