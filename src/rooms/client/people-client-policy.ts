import * as v from 'valibot';
import { roomMessageReader } from '../protocol/messages';
import { noMatchState, type People, peopleKind, sharedFloor } from '../room/people-policy';
import type { ClientPolicy } from './client-policy';

/** The client policy of a room without a game. */
export const peopleClientPolicy: ClientPolicy<People> = {
  kind: peopleKind,
  readMessage: roomMessageReader<People>(peopleKind, v.null(), v.never()),
  unpack: () => noMatchState,
  follow: (state) => state,
  at: (state) => state,
  predict: (state) => state,
  answers: () => false,
  arenaFromFloor: () => sharedFloor,
};
