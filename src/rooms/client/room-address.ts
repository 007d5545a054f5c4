import type { HostedGame } from '../room/match-policy';
import { type AvatarExchange, createAvatarExchange } from './avatar-exchange';
import type { ClientPolicy } from './client-policy';
import type { Connection, LocalClock, Visitor } from './connection';
import { createRoomPass, type PassStorage, type RoomPass } from './room-pass';
import { SocketConnection } from './socket-connection';

export interface RoomAddressOptions {
  /** The address of the server, without a trailing slash. */
  readonly url: string;
  /** The name of the room. */
  readonly room: string;
  /** The terms of the room, if this page is the first in it; its game defines them. */
  readonly terms?: object;
  /** Stores the pass, by which a reloaded page gets its seat back. Absent: a reloaded page is a new person. */
  readonly storage?: PassStorage;
  /** A pass that another service issues. Default: the server issues one. */
  readonly pass?: RoomPass;
  /** Default: `performance.now`, which skips no pauses. */
  readonly clock?: LocalClock;
}

/** The address of a room on a server, and this person's pass to it: creates connections and the avatar exchange. */
export class RoomAddress<Game extends HostedGame> {
  readonly pass: RoomPass;
  readonly avatars: AvatarExchange;
  readonly #game: ClientPolicy<Game>;
  readonly #options: RoomAddressOptions;

  constructor(game: ClientPolicy<Game>, options: RoomAddressOptions) {
    this.#game = game;
    this.#options = options;
    this.pass = options.pass ?? this.#createPass(options.storage);
    this.avatars = createAvatarExchange(options.url, options.room, this.pass);
  }

  /** Connects a visitor. Each bot is a guest with its own pass. `onStatus`: see SocketConnectionOptions. */
  connect(visitor: Visitor, onStatus?: () => void): Connection<Game> {
    const { url, room, clock } = this.#options;
    // A bot may be the first that comes back after the room was closed: its pass has the terms too.
    const pass = visitor.bot ? this.#createPass() : this.pass;
    return new SocketConnection(this.#game, {
      ...{ url, room, visitor, pass },
      ...(clock && { clock }),
      ...(onStatus && { onStatus }),
    });
  }

  #createPass(storage?: PassStorage): RoomPass {
    const { url, room, terms } = this.#options;
    return createRoomPass(url, room, this.#game.kind, storage, terms);
  }
}
