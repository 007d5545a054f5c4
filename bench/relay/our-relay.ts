// The relay as it ships, in a process of its own.
import type { AddressInfo } from 'node:net';
import { createRelay } from '../../server/relay';
import { relayConfigurationFrom } from '../../server/relay-configuration';
import { serve } from '../../server/web-server';
import type { RelayAnswer } from './conversation';

const tell = (answer: RelayAnswer): void => {
  process.send?.(answer);
};

const configuration = relayConfigurationFrom(process.env);
let relay: ReturnType<typeof createRelay> | null = null;
const server = await serve((request, response) => void relay?.handle(request, response), {
  host: '127.0.0.1',
  port: 0,
});
relay = createRelay(server.requests, configuration, configuration.secret ?? '');
process.on('message', () => {
  const { user, system } = process.cpuUsage();
  tell({ cpuMicroseconds: user + system, rssBytes: process.memoryUsage.rss() });
});
tell({ port: (server.requests.address() as AddressInfo).port });
