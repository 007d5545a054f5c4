// "threepoint-rooms/server": rooms on any HTTP server of Node.
export type { RoomTerms } from '../protocol/messages';
export type { HostedGame, HostedMatch, MatchAction, MatchPolicy, MatchState } from '../room/match-policy';
export type { AttachedRooms, AttachRoomsOptions } from './attach-rooms';
export { attachRooms } from './attach-rooms';
export type { RoomKinds } from './hosting/room-kinds';
