// "threepoint-rooms/three": the bodies of other people in a three.js scene.
export type { ConnectionStatus } from '../client/connection';
export type { Keep } from '../client/room-pass';
export type { AvatarLoader } from './drawn-bodies';
export type { JoinedRoom, JoinRoomOptions, RoomBody, RoomPerson } from './join-room';
export { joinRoom } from './join-room';
export type { RemoteBodiesOptions } from './remote-bodies';
export { placementOf, RemoteBodies } from './remote-bodies';
