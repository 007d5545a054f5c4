// "threepoint-rooms": sends and receives bodies over any transport; needs no three.js and no server.
export type { PlaybackReport } from '../client/playback';
export type { FloorPlacement } from '../protocol/pose-packet';
export { maxAvatarReferenceLength, maxPeerPacketBytes, peerPacketVersion } from './peer-packet';
export type { PoseSenderOptions, PoseSendOptions, PoseSource } from './pose-sender';
export { PoseSender } from './pose-sender';
export type { RemotePose, RemotePosesOptions } from './remote-poses';
export { RemotePoses } from './remote-poses';
