// "threepoint-rooms/three": the bodies of other people in a three.js scene.
export type { RemotePerson } from 'threepoint/core';
export type { ClientPolicy } from '../client/client-policy';
export type { Connection, ConnectionStatus, ConnectionUpdate, RoomView } from '../client/connection';
export { RoomAddress, type RoomAddressOptions } from '../client/room-address';
export { RoomClient } from '../client/room-client';
export type { PassStorage } from '../client/room-pass';
export type { AvatarLoader } from './drawn-bodies';
export type { JoinedRoom, JoinRoomOptions, RoomBody, RoomPerson } from './join-room';
export { joinRoom } from './join-room';
export type { RemoteBodiesOptions } from './remote-bodies';
export { placementOf, RemoteBodies } from './remote-bodies';
export { RoomBodies, type RoomBodiesOptions } from './room-bodies';
