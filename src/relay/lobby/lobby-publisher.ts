import { createAdapter } from '@socket.io/redis-adapter';
import type { Redis } from 'ioredis';
import type { Namespace, Server, Socket } from 'socket.io';
import type { RoomRegistry } from '../hosting/room-registry';
import type { RelayContext } from '../relay-context';
import type { Lobby } from './lobby';

/** The socket.io namespace in which pages receive the rooms of all processes. */
export const lobbyNamespace = '/lobby';

/** The Redis connections of socket.io's adapter. */
interface FleetChannel {
  readonly publisher: Redis;
  readonly subscriber: Redis;
}

interface LobbyPublisherOptions {
  readonly io: Server;
  readonly lobby: Lobby;
  /** The id of this process. */
  readonly node: string;
  /** null: a single process. */
  readonly channel: FleetChannel | null;
  /** The rooms of this process. */
  readonly rooms: Pick<RoomRegistry, 'listings' | 'end'>;
  readonly repeat: RelayContext['repeat'];
}

const lobbyEveryMs = 1000;
/** The event by which processes ask each other to end a room. */
const endEvent = 'end-room';

/** Publishes the rooms of all processes to pages, and asks all processes to end a room. */
export class LobbyPublisher {
  readonly #options: LobbyPublisherOptions;
  readonly #namespace: ReturnType<Server['of']>;
  readonly #timer: NodeJS.Timeout;
  /** The last published list of rooms, as JSON. */
  #published = '';

  constructor(options: LobbyPublisherOptions) {
    this.#options = options;
    const { io, lobby, channel, rooms } = options;
    if (channel) shareNamespace(io, channel);
    this.#namespace = io.of(lobbyNamespace);
    // The list is a thousand times as long as the request: once for each connection.
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
    this.#namespace.on(endEvent, (room: string) => rooms.end(room));
    this.#timer = options.repeat('the list of rooms', lobbyEveryMs, () => this.#publish());
  }

  /** Ends a room in all processes that are reachable. */
  endRoom(room: string): void {
    this.#options.rooms.end(room);
    if (this.#reachesAll) this.#namespace.serverSideEmit(endEvent, room);
  }

  close(): void {
    clearInterval(this.#timer);
  }

  /** Whether messages reach the other processes. */
  get #reachesAll(): boolean {
    return this.#options.channel?.publisher.status === 'ready';
  }

  #publish(): void {
    const { lobby, node, rooms: own } = this.#options;
    const rooms = own.listings;
    lobby.publish(rooms);
    const text = JSON.stringify(rooms);
    if (text === this.#published) return;
    this.#published = text;
    // While Redis is down, other processes' pages receive the list with the next change; nothing is queued.
    const listeners = this.#reachesAll ? this.#namespace : this.#namespace.local;
    listeners.emit('node', { node, rooms });
  }
}

/** Shares only the lobby's namespace over Redis; poses stay in the process of their room. */
function shareNamespace(io: Server, { publisher, subscriber }: FleetChannel): void {
  const shared = createAdapter(publisher, subscriber);
  const Local = io.adapter() as new (namespace: Namespace) => unknown;
  // socket.io calls it with `new` and uses what it returns.
  const adapterFor = function adapterFor(namespace: Namespace) {
    return namespace.name === lobbyNamespace ? shared(namespace) : new Local(namespace);
  };
  io.adapter(adapterFor as never);
}
