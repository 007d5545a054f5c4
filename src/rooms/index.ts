// "threepoint-rooms": sends and receives bodies over any transport; needs no three.js and no server.

export type { AvatarExchange } from './client/avatar-exchange';
export { bannerText, connectionText } from './client/connection-text';
export type { PlaybackReport } from './client/playback';
export { RoomClient } from './client/room-client';
export type { OwnAvatar } from './client/shared-avatar';
export { maxAvatarReferenceLength, maxPeerPacketBytes, peerPacketVersion } from './peers/peer-packet';
export type { PoseSenderOptions, PoseSendOptions, PoseSource } from './peers/pose-sender';
export { PoseSender } from './peers/pose-sender';
export type { RemotePose, RemotePosesOptions } from './peers/remote-poses';
export { RemotePoses } from './peers/remote-poses';
export type { FloorPlacement } from './protocol/pose-packet';
export { IceServerCache } from './voices/ice-server-cache';
export { Microphone } from './voices/microphone';
export { VoiceMesh } from './voices/voice-mesh';
export type { VoiceSettings } from './voices/voice-settings';
export { fetchVoiceSettings, hasRelay } from './voices/voice-settings';
