// "threepoint-rooms/room": the authority of a room, its messages, and what a game implements. It has no socket.
export type { ClientPolicy } from './client/client-policy';
export type { Connection, ConnectionStatus, ConnectionUpdate, RoomView, Visitor } from './client/connection';
export { LoopbackHost, type LoopbackOptions } from './client/loopback-host';
export { finiteWithin, integerWithin, type RoomMessage, roomMessageReader, seconds } from './protocol/messages';
export type { HostedGame, HostedMatch, MatchAction, MatchPolicy, MatchState } from './room/match-policy';
export type { RoomKind, RoomKinds } from './room/room-kind';
