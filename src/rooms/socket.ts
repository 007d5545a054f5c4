// "threepoint-rooms/socket": rooms on a threepoint server, over socket.io.
export { createAvatarExchange } from './client/avatar-exchange';
export { RoomAddress, type RoomAddressOptions } from './client/room-address';
export { createRoomPass, type PassStorage, type RoomPass, tabStorage } from './client/room-pass';
export { SocketConnection } from './client/socket-connection';
