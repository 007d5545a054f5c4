import { createAdapter } from '@socket.io/redis-adapter';
import type { Redis } from 'ioredis';
import type { Server, Socket } from 'socket.io';
import { Adapter } from 'socket.io-adapter';
import type { RoomListing } from '../hosting/room-registry';
import type { Lobby } from './lobby';

/** Where a page hears of rooms that open, fill and close, in any process of a fleet. */
export const lobbyNamespace = '/lobby';

/** The connections over which the processes of a fleet tell each other. */
export interface FleetChannel {
  readonly publisher: Redis;
  readonly subscriber: Redis;
}

export interface LobbyPublisherOptions {
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
export class LobbyPublisher {
  readonly #options: LobbyPublisherOptions;
  readonly #namespace: ReturnType<Server['of']>;
  readonly #timer: NodeJS.Timeout;
  /** The rooms as pages were last told. */
  #published = '';

  constructor(options: LobbyPublisherOptions) {
    this.#options = options;
    const { io, lobby, channel, endRoom } = options;
    if (channel) shareNamespace(io, channel);
    this.#namespace = io.of(lobbyNamespace);
    // A list is a thousand times as long as the question for it.
    const answered = new WeakSet<Socket['conn']>();
    this.#namespace.on('connection', (socket) => {
      if (answered.has(socket.conn)) {
        socket.disconnect(true);
        return;
      }
      answered.add(socket.conn);
      void lobby.list().then((all) => socket.emit('rooms', all));
      socket.onAny(() => socket.disconnect(true));
    });
    this.#namespace.on(endEvent, (room: string) => endRoom(room));
    this.#timer = setInterval(() => this.#publish(), lobbyEveryMs);
  }

  /** Ends a room in all processes that can be reached. */
  endRoom(room: string): void {
    this.#options.endRoom(room);
    if (this.#reachesAll) this.#namespace.serverSideEmit(endEvent, room);
  }

  close(): void {
    clearInterval(this.#timer);
  }

  /** A process that is alone, or out of reach of Redis, is all there is. */
  get #reachesAll(): boolean {
    return this.#options.channel?.publisher.status === 'ready';
  }

  #publish(): void {
    const rooms = this.#options.rooms();
    this.#options.lobby.publish(rooms);
    const text = JSON.stringify(rooms);
    if (text === this.#published) return;
    this.#published = text;
    // What cannot be told now is told with the next change: without Redis nothing piles up.
    const listeners = this.#reachesAll ? this.#namespace : this.#namespace.local;
    listeners.emit('node', { node: this.#options.node, rooms });
  }
}

/** Carries the lobby alone over Redis: poses stay in the process that has the room. */
function shareNamespace(io: Server, { publisher, subscriber }: FleetChannel): void {
  const shared = createAdapter(publisher, subscriber);
  // socket.io calls it with new, and takes what it returns.
  const adapterFor = function adapterFor(namespace: ConstructorParameters<typeof Adapter>[0]) {
    return namespace.name === lobbyNamespace ? shared(namespace) : new Adapter(namespace);
  };
  io.adapter(adapterFor as never);
}
