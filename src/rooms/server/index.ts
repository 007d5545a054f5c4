// "threepoint-rooms/server": rooms on any HTTP server of Node.
export type { HostedGame, HostedMatch, MatchAction, MatchPolicy, MatchState } from '../room/match-policy';
export type { RoomKind, RoomKinds } from '../room/room-kind';
export type { AttachedRooms, AttachRoomsOptions } from './attach-rooms';
export { attachRooms } from './attach-rooms';
