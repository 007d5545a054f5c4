// "threepoint-relay": rooms on any HTTP server of Node.
export { type PassClaims, RoomTokens } from './access/room-tokens';
export { type AttachedRooms, type AttachRoomsOptions, attachRooms } from './attach-rooms';
export { type RelayConfiguration, relayConfigurationFrom, relayEnvironment } from './settings/relay-configuration';
