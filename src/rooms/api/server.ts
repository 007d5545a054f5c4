// "threepoint-rooms/server": rooms on any HTTP server of Node.
export type { RoomTerms } from '../protocol/messages';
export type { HostedGame, HostedMatch, MatchAction, MatchPolicy, MatchState } from '../room/match-policy';
export type { RoomKinds } from '../server/hosting/room-kinds';
export type { AttachedRooms, AttachRoomsOptions } from './attach-rooms';
export { attachRooms } from './attach-rooms';
