import { gameNames, games } from 'threepoint-games/all';
import { expect, test } from 'vitest';
import { shippedRoomKinds } from '../../server/room-kinds';

test('every game that participants of a study play together has a kind of room', async () => {
  const together = gameNames.filter((name) => games[name].players > 1);
  expect([...(await shippedRoomKinds({})).keys()]).toEqual(expect.arrayContaining(together));
});
