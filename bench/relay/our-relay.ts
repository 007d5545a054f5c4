// The relay as it ships, in a process of its own; beside the ball game it hosts one with room for sixteen.
import { ConnectionLimiter, createRouter, noPage } from 'threepoint-http';
import type { RoomKind } from 'threepoint-rooms/room';
import { relayConfigurationFrom } from 'threepoint-rooms/settings';
import { shippedRoomKinds } from '../../server/room-kinds';
import { maxSeats } from '../../src/rooms/protocol/messages';
import { createRelay } from '../../src/rooms/server/relay';
import { serve } from '../../tests/http/serve';
import { countingKind, countingRoomKind } from '../../tests/rooms/room/counting-game';
import { answerAsRelay } from './conversation';

const configuration = relayConfigurationFrom(process.env);
const connectionLimiter = new ConnectionLimiter({
  perAddress: configuration.connectionsPerAddress,
  behindProxy: configuration.trustProxy,
});
const kinds = new Map<string, RoomKind>([
  ...(await shippedRoomKinds(process.env)),
  [countingKind, countingRoomKind(maxSeats)],
]);
const relay = createRelay(configuration, configuration.secret ?? '', connectionLimiter, kinds);
const server = await serve(createRouter([relay.service], noPage), {
  upgrade: relay.upgrade,
  connectionLimiter,
});
answerAsRelay(server.port);
