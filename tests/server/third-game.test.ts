import { expect, test } from 'vitest';
import { usage } from '../../server/configuration';
import { shippedRoomKinds } from '../../server/room-kinds';

test('an entry gives the server rooms of a third game, and --help its variable', async () => {
  expect([...(await shippedRoomKinds({ THREEPOINT_TOUCH_SECONDS: '20' })).keys()]).toEqual(['touch', 'ball']);
  await expect(shippedRoomKinds({ THREEPOINT_TOUCH_SECONDS: 'long' })).rejects.toThrow('THREEPOINT_TOUCH_SECONDS');
  expect(usage).toContain('THREEPOINT_TOUCH_SECONDS, default 30; THREEPOINT_BALL_SECONDS, default 90');
});
