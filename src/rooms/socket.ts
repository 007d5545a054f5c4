// "threepoint-rooms/socket": rooms on a threepoint server, over socket.io.
export { RoomAddress, type RoomAddressOptions } from './client/room-address';
export { type PassStorage, tabStorage } from './client/room-pass';
