import { defaultCalibration } from 'threepoint/core';
import { type BallGame, BallPolicy, ballClientPolicy } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import type { ConnectionStatus, ConnectionUpdate } from '../../../src/rooms/client/connection';
import { RoomSession } from '../../../src/rooms/client/room-session';
import type { ClientMessage, RoomMessage } from '../../../src/rooms/protocol/messages';
import { Room } from '../../../src/rooms/room/room';
import { visitor } from './people';

/** A client whose wire takes as long as the test wants: what the Room says waits until it is delivered. */
class SlowClient extends RoomSession<BallGame> {
  readonly #room: Room<BallGame>;
  readonly #waiting: RoomMessage<BallGame>[] = [];
  #joins = 0;
  #time = 0;
  #isJoined = false;

  constructor() {
    super(ballClientPolicy, visitor('Ann'), false);
    this.#room = new Room<BallGame>(
      new BallPolicy({ seed: 0 }),
      { id: 'here', epoch: 'here', voices: true },
      {
        send: (_to, message) => this.#waiting.push(message),
        broadcast: (message) => this.#waiting.push(message),
        ...{ sendPoses: () => undefined, disconnect: () => undefined, rejected: () => undefined },
      },
    );
  }

  /** What the Room knows of the person on the first seat. */
  get known() {
    const { voice, avatar, calibration } = this.room?.seats[0] ?? {};
    return { voice, avatar, height: calibration?.eyeHeight };
  }

  /** The connection is there: the first message is on its way. */
  connect(): void {
    this.#joins += 1;
    this.#room.join(`connection ${this.#joins}`, 'ann', this.joinRequest(), this.#time);
  }

  lose(): void {
    this.#isJoined = false;
    this.#room.disconnect(`connection ${this.#joins}`, this.#time);
  }

  /** What the Room has said until now arrives, and what it says to the answers. */
  deliver(): void {
    this.#hear();
    this.#time += 0.1;
    this.#room.tick(this.#time);
    this.#hear();
  }

  #hear(): void {
    for (let message = this.#waiting.shift(); message; message = this.#waiting.shift()) {
      if (message.type === 'welcome') this.#isJoined = true;
      this.onMessage(message, this.#time);
    }
  }

  override get status(): ConnectionStatus {
    return { phase: this.#isJoined ? 'joined' : 'connecting', attempt: 0, retryIn: null, reason: null };
  }

  override update(time: number): ConnectionUpdate<BallGame> {
    return this.takeUpdate(time, this.#isJoined);
  }

  override leave(): void {
    this.lose();
  }

  protected override transmit(message: ClientMessage): void {
    if (this.#isJoined && message.type !== 'join') {
      this.#room.onMessage(`connection ${this.#joins}`, message, this.#time);
    }
  }

  protected override transmitPose(): void {
    throw new Error('no pose is sent in these tests');
  }
}

const taller = { ...defaultCalibration, eyeHeight: 1.75 };

function change(client: SlowClient): void {
  client.voices.setVoice({ session: 'annas-page', muted: true });
  client.calibrate(taller);
  client.setAvatar('man-dark');
}

const changed = { voice: { session: 'annas-page', muted: true }, avatar: 'man-dark', height: 1.75 };

test('a change during the welcome reaches the room, on joining and on returning', () => {
  const client = new SlowClient();
  client.connect();
  change(client);
  client.deliver();
  expect(client.known).toEqual(changed);

  client.voices.setVoice({ session: 'annas-page', muted: false });
  client.deliver();
  client.lose();
  client.connect();
  client.voices.setVoice({ session: 'annas-page', muted: true });
  client.deliver();
  expect(client.known).toEqual(changed);
});

test('a change without a connection is part of the first message on the next one', () => {
  const client = new SlowClient();
  client.connect();
  client.deliver();
  client.lose();
  change(client);
  client.connect();
  client.deliver();
  expect(client.known).toEqual(changed);
});

/** What the Room knows of what the person wants. */
function wanted(client: SlowClient) {
  const { seats = [], mySeat, match } = client.room ?? {};
  const [seat] = seats;
  return { seat: mySeat, isReady: match?.players[0]?.ready, presence: seat?.presence };
}

test('a press without a connection, or before its welcome, reaches the room', () => {
  const client = new SlowClient();
  client.connect();
  client.setReady(true);
  client.setAway(true);
  client.deliver();
  expect(wanted(client)).toEqual({ seat: 0, isReady: true, presence: 'away' });

  client.lose();
  client.setReady(true);
  client.setReady(false);
  client.setAway(false);
  client.connect();
  client.deliver();
  expect(wanted(client)).toEqual({ seat: 0, isReady: false, presence: 'here' });

  client.lose();
  client.changeSeat(null);
  client.connect();
  client.deliver();
  expect(wanted(client).seat).toBeNull();
});

test('a press on one connection is not repeated on the next', () => {
  const client = new SlowClient();
  client.connect();
  client.setReady(true);
  client.deliver();
  client.setReady(false);
  client.deliver();
  client.lose();
  client.connect();
  client.deliver();
  expect(wanted(client).isReady).toBe(false);
});
