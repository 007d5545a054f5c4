import { gameNames, studiedGames } from 'threepoint-study';
import { expect, test } from 'vitest';
import { shippedRoomKinds } from '../../server/room-kinds';

test('every game that participants of a study play together has a kind of room', () => {
  const together = gameNames.filter((name) => studiedGames[name].players > 1);
  expect([...shippedRoomKinds({}).keys()]).toEqual(expect.arrayContaining(together));
});
