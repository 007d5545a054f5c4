// "threepoint-rooms/three": the bodies of other people in a three.js scene.
export { type JoinedRoom, type JoinRoomOptions, joinRoom, type RoomBody, type RoomPerson } from './join-room';
export { type AvatarLoader, placementOf, RemoteBodies, type RemoteBodiesOptions } from './remote-bodies';
