import { createAdapter } from '@socket.io/redis-adapter';
import type { Redis } from 'ioredis';
import type { Server, Socket } from 'socket.io';
import { Adapter } from 'socket.io-adapter';
import type { RoomListing } from './hosted-rooms';
import type { Lobby } from './lobby';

/** Where a page hears of rooms that open, fill and close, in any process of a fleet. */
export const lobbyNamespace = '/lobby';

/** The connections over which the processes of a fleet tell each other. */
export interface FleetChannel {
  readonly told: Redis;
  readonly heard: Redis;
}

export interface LobbyHallOptions {
  readonly io: Server;
  readonly lobby: Lobby;
  /** This process, as others know it. */
  readonly node: string;
  /** null: this process is alone. */
  readonly channel: FleetChannel | null;
  /** The rooms of this process. */
  readonly rooms: () => readonly RoomListing[];
  /** Ends a room of this process, where there is one of this name. */
  readonly endRoom: (room: string) => void;
}

const lobbyEveryMs = 1000;
/** What the processes of a fleet tell each other: that a room is to end. */
const endEvent = 'end-room';

/** Tells pages of the rooms of all processes, and the processes that a room is to end. */
export class LobbyHall {
  readonly #options: LobbyHallOptions;
  readonly #hall: ReturnType<Server['of']>;
  readonly #timer: NodeJS.Timeout;
  /** The rooms as pages were last told. */
  #told = '';

  constructor(options: LobbyHallOptions) {
    this.#options = options;
    const { io, lobby, channel, endRoom } = options;
    if (channel) shareNamespace(io, channel);
    this.#hall = io.of(lobbyNamespace);
    // A list is a thousand times as long as the question for it.
    const answered = new WeakSet<Socket['conn']>();
    this.#hall.on('connection', (socket) => {
      if (answered.has(socket.conn)) {
        socket.disconnect(true);
        return;
      }
      answered.add(socket.conn);
      void lobby.list().then((all) => socket.emit('rooms', all));
      socket.onAny(() => socket.disconnect(true));
    });
    this.#hall.on(endEvent, (room: string) => endRoom(room));
    this.#timer = setInterval(() => this.#publish(), lobbyEveryMs);
  }

  /** Ends a room in all processes that can be reached. */
  endRoom(room: string): void {
    this.#options.endRoom(room);
    if (this.#reachesAll) this.#hall.serverSideEmit(endEvent, room);
  }

  close(): void {
    clearInterval(this.#timer);
  }

  /** A process that is alone, or out of reach of Redis, is all there is. */
  get #reachesAll(): boolean {
    return this.#options.channel?.told.status === 'ready';
  }

  #publish(): void {
    const rooms = this.#options.rooms();
    this.#options.lobby.publish(rooms);
    const text = JSON.stringify(rooms);
    if (text === this.#told) return;
    this.#told = text;
    // What cannot be told now is told with the next change: without Redis nothing piles up.
    const listeners = this.#reachesAll ? this.#hall : this.#hall.local;
    listeners.emit('node', { node: this.#options.node, rooms });
  }
}

/** Carries the lobby alone over Redis: poses stay in the process that has the room. */
function shareNamespace(io: Server, { told, heard }: FleetChannel): void {
  const shared = createAdapter(told, heard);
  // socket.io calls it with new, and takes what it returns.
  const adapterFor = function adapterFor(namespace: ConstructorParameters<typeof Adapter>[0]) {
    return namespace.name === lobbyNamespace ? shared(namespace) : new Adapter(namespace);
  };
  io.adapter(adapterFor as never);
}
