// "threepoint-rooms/server": rooms on any HTTP server of Node.
export type { RoomTerms } from '../protocol/messages';
export type { HostedGame, HostedMatch, MatchAction, MatchPolicy, MatchState } from '../room/match-policy';
export { RoomTokens } from './access/room-tokens';
export type { AttachedRooms, AttachRoomsOptions } from './attach-rooms';
export { attachRooms } from './attach-rooms';
export type { RoomKinds } from './hosting/room-kinds';
export type { RelayConfiguration } from './settings/relay-configuration';
export { relayConfigurationFrom, relayEnvironment } from './settings/relay-configuration';
export { loadOrCreateSecret } from './settings/stored-secret';
