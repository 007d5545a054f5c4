// "threepoint-rooms": sends and receives bodies over any transport; needs no three.js and no server.

export { RoomClient } from './client/room-client';
export { maxPeerPacketBytes } from './peers/peer-packet';
export { PoseSender, type PoseSenderOptions, type PoseSendOptions, type PoseSource } from './peers/pose-sender';
export { type RemoteEvents, type RemotePose, RemotePoses, type RemotePosesOptions } from './peers/remote-poses';
export type { FloorPlacement } from './protocol/pose-packet';
