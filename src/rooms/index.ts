// "threepoint-rooms": sends and receives bodies over any transport; needs no three.js and no server.

export type { AvatarExchange } from './client/avatar-exchange';
export { bannerText, connectionText } from './client/connection-text';
export { RoomClient } from './client/room-client';
export type { OwnAvatar } from './client/shared-avatar';
export { maxPeerPacketBytes } from './peers/peer-packet';
export { PoseSender, type PoseSenderOptions, type PoseSendOptions, type PoseSource } from './peers/pose-sender';
export { type RemotePose, RemotePoses, type RemotePosesOptions } from './peers/remote-poses';
export type { FloorPlacement } from './protocol/pose-packet';
export { IceServerCache } from './voices/ice-server-cache';
export { Microphone } from './voices/microphone';
export { VoiceMesh } from './voices/voice-mesh';
export { fetchVoiceSettings, hasRelay, type VoiceSettings } from './voices/voice-settings';
