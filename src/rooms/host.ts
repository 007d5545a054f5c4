// "threepoint-rooms/host": what a host of rooms consists of. It is not published; the relay is bundled with it.
export {
  type ClientMessage,
  clientMessageFrom,
  type DisconnectReason,
  maxMessageBytes,
  maxSeats,
  protocolVersion,
} from './protocol/messages';
export { encodeFrame } from './protocol/pose-frame';
export { messageEvent, pageParser, poseEvent, relayParser } from './protocol/socket-parsers';
export { peopleKind, peopleRoomKind } from './room/people-policy';
export { Room, type RoomCensus } from './room/room';
export type { FreshPose } from './room/room-host';
export { TokenBucket } from './room/token-bucket';
