// "threepoint-rooms/server": rooms on any HTTP server of Node.
export type { HostedGame, HostedMatch, MatchAction, MatchPolicy, MatchState } from '../room/match-policy';
export type { RoomKind, RoomKinds } from '../room/room-kind';
export { RoomTokens } from './access/room-tokens';
export type { AttachedRooms, AttachRoomsOptions } from './attach-rooms';
export { attachRooms } from './attach-rooms';
export type { Environment } from './settings/environment';
export { numberFrom } from './settings/environment';
export type { RelayConfiguration } from './settings/relay-configuration';
export { relayConfigurationFrom, relayEnvironment } from './settings/relay-configuration';
export { loadOrCreateSecret } from './settings/stored-secret';
