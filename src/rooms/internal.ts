// "threepoint-rooms/internal": the parts of a room that this repository's page combines itself. It is not published.

export { type AvatarExchange, createAvatarExchange } from './client/avatar-exchange';
export type { LocalClock, SeenAbsence, VoiceChannel } from './client/connection';
export { bannerText, connectionText } from './client/connection-text';
export { createRoomPass, type RoomPass } from './client/room-pass';
export type { OwnAvatar } from './client/shared-avatar';
export { SocketConnection } from './client/socket-connection';
export type { SignalBody } from './protocol/voice-messages';
export { IceServerCache } from './voices/ice-server-cache';
export { Microphone } from './voices/microphone';
export { VoiceMesh } from './voices/voice-mesh';
export { fetchVoiceSettings, hasRelay, type VoiceSettings } from './voices/voice-settings';
