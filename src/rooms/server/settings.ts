// "threepoint-rooms/settings": settings and passes of a server that shares them with studies. It is not published.
export { RoomTokens } from './access/room-tokens';
export type { Environment } from './settings/environment';
export { numberFrom } from './settings/environment';
export type { RelayConfiguration } from './settings/relay-configuration';
export { relayConfigurationFrom, relayEnvironment } from './settings/relay-configuration';
export { loadOrCreateSecret } from './settings/stored-secret';
