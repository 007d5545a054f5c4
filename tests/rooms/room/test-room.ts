import { defaultAvatar, defaultCalibration, skeletonFromCalibration } from 'threepoint/core';
import {
  type BallEvent,
  type BallGame,
  type BallInput,
  BallPolicy,
  type BallState,
  ballClientPolicy,
} from 'threepoint-games/ball';
import {
  type ClientMessage,
  type JoinRequest,
  protocolVersion,
  type RoomMessage,
} from '../../../src/rooms/protocol/messages';
import { packetMs } from '../../../src/rooms/protocol/packet-time';
import { encodePose } from '../../../src/rooms/protocol/pose-codec';
import { encodeFrame } from '../../../src/rooms/protocol/pose-frame';
import { Room, type RoomOptions } from '../../../src/rooms/room/room';
import type { RoomRejection } from '../../../src/rooms/room/room-host';
import { atRack, fists, holding, opening, releaseOf, shownAt, velocityTo } from '../client/people';

const skeleton = skeletonFromCalibration(defaultCalibration);

export const joinRequest = (more: Partial<JoinRequest> = {}): JoinRequest => ({
  name: 'Ann',
  calibration: defaultCalibration,
  spectate: false,
  bot: false,
  seat: null,
  avatar: defaultAvatar,
  voice: null,
  ...more,
});

/** The first message of a client. */
export const joinMessage = (more: Partial<JoinRequest> = {}): ClientMessage => ({
  type: 'join',
  version: protocolVersion,
  ...joinRequest(more),
});

/** The clients of a match: Ann and Ben throw, Cal holds the basket. */
export const trio = ['ann', 'ben', 'cal'] as const;

type Wrists = ReturnType<typeof fists>;

/**
 * The packet of a player on a seat with these wrists (arena frame of the ball game), taken at this time of the room
 * clock [s].
 */
export function packetAt(match: BallState | null, seat: number, wrists: Wrists, time: number): Uint8Array {
  const shown = shownAt({ arenaFromFloor: (index) => ballClientPolicy.arenaFromFloor(index, match) }, seat, wrists);
  const bytes = encodePose({ ...shown, timeMs: packetMs(time * 1000) }, skeleton);
  if (!bytes) throw new Error('the pose packet of the tests is not finite');
  return bytes;
}

interface TestRoomOptions extends Partial<RoomOptions> {
  readonly ball?: ConstructorParameters<typeof BallPolicy>[0];
}

/** A room of the ball game that a test controls; it collects all messages, and checks that a page can read each. */
export function createTestRoom({ ball, ...options }: TestRoomOptions = {}) {
  const sent: { readonly to: string; readonly message: RoomMessage<BallGame> }[] = [];
  const frames: Uint8Array[] = [];
  const dropped: { readonly client: string; readonly reason: string }[] = [];
  const refusals: RoomRejection[] = [];
  const log: (readonly BallInput[])[] = [];
  let time = 1000;
  const hear = (to: string, message: RoomMessage<BallGame>) => {
    const read = ballClientPolicy.readMessage(JSON.parse(JSON.stringify(message)));
    if (!read) throw new Error(`no page can read this: ${JSON.stringify(message)}`);
    sent.push({ to, message: read });
  };
  const room = new Room<BallGame>(
    new BallPolicy(ball),
    { id: 'room', epoch: 'one', ...options },
    {
      send: hear,
      broadcast: (message) => hear('all', message),
      sendPoses: (poses) => frames.push(encodeFrame(poses)),
      disconnect: (client, reason) => dropped.push({ client, reason }),
      rejected: (refusal) => refusals.push(refusal),
      stepped: (actions) => log.push(actions),
    },
  );
  const testRoom = {
    room,
    sent,
    frames,
    dropped,
    refusals,
    log,
    get time() {
      return time;
    },
    join(client: string, more: Partial<JoinRequest> = {}, identity = client) {
      room.join(client, identity, joinRequest(more), time);
      return testRoom.welcomeOf(client);
    },
    welcomeOf(client: string) {
      const welcome = sent.findLast(({ to, message }) => to === client && message.type === 'welcome')?.message;
      if (welcome?.type !== 'welcome') throw new Error(`${client} was not welcomed`);
      return welcome;
    },
    tick(seconds = 1 / 60) {
      time += seconds;
      room.tick(time);
      room.sendPoses();
    },
    pass(seconds: number, everyTick: () => void = () => undefined) {
      for (let i = 0; i < Math.round(seconds * 60); i++) {
        everyTick();
        testRoom.tick();
      }
    },
    packet: (seat: number, wrists: Wrists, at = time) => packetAt(room.match, seat, wrists, at),
    send: (client: string, bytes: Uint8Array) => room.onPose(client, bytes, time),
    pose: (client: string, seat: number, wrists: Wrists, at = time) =>
      testRoom.send(client, testRoom.packet(seat, wrists, at)),
    say: (client: string, message: Exclude<ClientMessage, { type: 'join' }>) => room.onMessage(client, message, time),
    act: (client: string, action: BallGame['action']) => testRoom.say(client, { type: 'action', action }),
    ready(clients: readonly string[] = trio) {
      for (const client of clients) testRoom.say(client, { type: 'ready', ready: true });
    },
    /** Ann reaches for a ball in its rack and grabs it. */
    grab(ball = 0, sequence = 1) {
      testRoom.pose('ann', 0, atRack(ball, room.match.options.balls), time + 0.01);
      testRoom.tick();
      testRoom.act('ann', { type: 'grab', sequence, side: 'right', ball });
    },
    /** Ann's throw of a ball from where she releases it, now. Default: into the basket in a second. */
    throwOf(ball: number, sequence: number, velocity = velocityTo(releaseOf(0), opening, 1)): BallGame['action'] {
      const at = time - testRoom.welcomeOf('ann').matchStart;
      return { type: 'throw', sequence, side: 'right', ball, at, position: releaseOf(0), velocity };
    },
    /** Ann and Ben throw, Cal holds the basket; all ready. */
    begin() {
      for (const client of trio) testRoom.join(client, { name: client });
      testRoom.ready();
      testRoom.stand();
      testRoom.tick();
      testRoom.tick();
    },
    /** All three are seen where they begin. */
    stand() {
      if (room.match.players[0]?.present) testRoom.poseOf('ann');
      if (room.match.players[1]?.present) testRoom.poseOf('ben');
      testRoom.poseOf('cal');
    },
    /** One of the three is seen where they begin. */
    poseOf(client: (typeof trio)[number]) {
      const seat = trio.indexOf(client);
      return testRoom.pose(client, seat, client === 'cal' ? holding(opening) : fists(releaseOf(seat as 0 | 1)));
    },
    events: () =>
      sent.flatMap(({ message }): readonly BallEvent[] => (message.type === 'events' ? message.events : [])),
    happened: <T extends BallEvent['type']>(type: T) =>
      testRoom.events().filter((event): event is Extract<BallEvent, { type: T }> => event.type === type),
  };
  return testRoom;
}
