// The relay as it ships, in a process of its own.
import { createDoor } from '../../server/door';
import { createRouter, noPage } from '../../server/http/router';
import { createRelay } from '../../server/relay';
import { relayConfigurationFrom } from '../../server/relay-configuration';
import { serve } from '../../server/web-server';
import type { RelayAnswer } from './conversation';

const tell = (answer: RelayAnswer): void => {
  process.send?.(answer);
};

const configuration = relayConfigurationFrom(process.env);
const door = createDoor({ perAddress: configuration.connectionsPerAddress, behindProxy: configuration.trustProxy });
const relay = createRelay(configuration, configuration.secret ?? '', door);
const server = await serve(createRouter([relay.service], noPage), {
  host: '127.0.0.1',
  port: 0,
  upgrade: relay.upgrade,
  door,
});
process.on('message', () => {
  const { user, system } = process.cpuUsage();
  tell({ cpuMicroseconds: user + system, rssBytes: process.memoryUsage.rss() });
});
tell({ port: server.port });
