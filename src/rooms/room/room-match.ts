import { transformPoint, transformTracked } from 'threepoint/core/math/pose';
import type { PointsPacket } from '../protocol/pose-packet';
import { MatchClock } from './match-clock';
import type { HostedGame, MatchPolicy } from './match-policy';
import type { RoomHost } from './room-host';
import type { Seats } from './seats';

/** The match of one room: passes actions and poses to the rules, and reports to all clients what happened. */
export class RoomMatch<Game extends HostedGame> {
  readonly clock: MatchClock<Game>;
  readonly #policy: MatchPolicy<Game>;
  readonly #seats: Seats;
  readonly #host: RoomHost<Game>;

  constructor(policy: MatchPolicy<Game>, seats: Seats, host: RoomHost<Game>) {
    this.#policy = policy;
    this.#seats = seats;
    this.#host = host;
    this.clock = new MatchClock(policy, {
      onEvents: (events) => this.#sendEvents(events),
      onPauseChange: () =>
        host.broadcast({ type: 'paused', at: this.clock.pausedAt, matchStart: this.clock.matchStart }),
      onStartShift: () => host.broadcast({ type: 'match-start', matchStart: this.clock.matchStart }),
      onRestart: () => host.broadcast({ type: 'match', match: this.snapshot(), matchStart: this.clock.matchStart }),
      onStep: (actions) => host.stepped?.(actions),
    });
  }

  snapshot(): Game['snapshot'] {
    return this.#policy.snapshot(this.clock.state);
  }

  /** Steps the match up to this time [s]. */
  step(time: number): void {
    this.clock.step(time, this.#seats.pauseRequested);
  }

  /** Queues whether a player is ready; ignored during a pause, because no step takes what is queued. */
  setReady(player: number, ready: boolean): void {
    if (!this.clock.isPaused) this.clock.add({ type: 'ready', player, ready });
  }

  /**
   * Queues an action of the player on a seat; during a pause the player receives a refusal instead. Returns 'bad' for a
   * value that is not an action of the game, and 'no-seat' where the client has no seat (null).
   */
  act(player: number | null, value: unknown): 'taken' | 'bad' | 'no-seat' {
    const action = this.#policy.readAction(value);
    if (!action) return 'bad';
    if (player === null) return 'no-seat';
    if (this.clock.isPaused) this.#sendEvents([this.#policy.refusalInPause(player, action)]);
    else this.clock.add({ ...action, player });
    return 'taken';
  }

  /**
   * Queues the pose of the player on a seat, in the arena frame; ignored during a pause. `packetTime`: room time of the
   * pose [s].
   */
  addPose(player: number, { pose: { head, leftHand, rightHand } }: PointsPacket, packetTime: number): void {
    if (this.clock.isPaused) return;
    const arenaFromFloor = this.#policy.arenaFromFloor(player, this.clock.state);
    this.clock.add({
      type: 'pose',
      player,
      at: packetTime - this.clock.matchStart,
      head: transformPoint(arenaFromFloor, head.position),
      left: transformTracked(arenaFromFloor, leftHand),
      right: transformTracked(arenaFromFloor, rightHand),
    });
  }

  /** Sends events to all clients, and each refusal to the player whose action it refuses. */
  #sendEvents(events: readonly Game['event'][]): void {
    const shared = events.filter((event) => !this.#policy.refusalOf(event));
    if (shared.length > 0) this.#host.broadcast({ type: 'events', events: shared });
    for (const event of events) {
      const refusal = this.#policy.refusalOf(event);
      const client = refusal && this.#seats.at(refusal.player)?.client;
      if (!refusal || !client) continue;
      this.#host.send(client, { type: 'events', events: [event] });
      this.#host.refused({ client, seat: refusal.player, what: 'action', reason: refusal.reason });
    }
  }
}
