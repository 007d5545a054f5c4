// The relay as it ships, in a process of its own; beside the ball game it hosts one with room for sixteen.
import { createConnectionLimiter } from '../../server/connection-limiter';
import { createRouter, noPage } from '../../server/http/router';
import { createRelay } from '../../server/relay';
import { relayConfigurationFrom } from '../../server/relay-configuration';
import { shippedRoomKinds } from '../../server/room-kinds';
import { serve } from '../../server/web-server';
import { mostSeats } from '../../src/core/protocol/messages';
import { countingKind, countingPolicy } from '../../tests/core/room/counting-game';
import type { RelayAnswer } from './conversation';

const tell = (answer: RelayAnswer): void => {
  process.send?.(answer);
};

const configuration = relayConfigurationFrom(process.env);
const connectionLimiter = createConnectionLimiter({
  perAddress: configuration.connectionsPerAddress,
  behindProxy: configuration.trustProxy,
});
const kinds = new Map([...shippedRoomKinds(configuration), [countingKind, () => countingPolicy(mostSeats)]]);
const relay = createRelay(configuration, configuration.secret ?? '', connectionLimiter, kinds);
const server = await serve(createRouter([relay.service], noPage), {
  host: '127.0.0.1',
  port: 0,
  upgrade: relay.upgrade,
  connectionLimiter,
});
process.on('message', () => {
  const { user, system } = process.cpuUsage();
  tell({ cpuMicroseconds: user + system, rssBytes: process.memoryUsage.rss() });
});
tell({ port: server.port });
