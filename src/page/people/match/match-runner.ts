import type { GameName } from 'threepoint-games/all';
import type { HostedGame } from 'threepoint-rooms/room';
import { PhrasedError } from 'threepoint-study';
import type { TaskEnd, TaskEvent, TaskPlace } from 'threepoint-study/participant';
import type { ActivityRunner, RunnerServices } from '../../activity/activity';
import type { MatchFrame } from './match-frame';
import type { MatchPlay } from './match-play';
import type { SeatedGame } from './seated-game';

/** The part of an activity that a study uses. */
export interface StudiedMatch<Game extends HostedGame> {
  readonly play: Pick<MatchPlay<Game>, 'newest' | 'room' | 'connection'>;
}

/** A game as a task: its figures, and what its events are for participants. */
export interface MatchTask<Game extends HostedGame> extends Pick<SeatedGame<Game>, 'figures'> {
  /** The name of the game in plans. */
  readonly name: GameName;
  /** Returns what an event is for the participant on this seat, at this second of their trial. */
  taskEvents(event: Game['event'], me: number | null, at: number): readonly TaskEvent[];
}

/** The longest delay of the room's bell after this page's [s]: the room counts from the moment it started the match. */
const bellDelay = 4;

/**
 * One participant's trial: which part of the match on the page counts for it, what happens to them there, and how it
 * ends.
 */
class MatchTrial<Game extends HostedGame> {
  /** Second of the match at which it began; null: not yet. */
  #from: number | null = null;
  /** The room that it began in. */
  #epoch = '';
  #happened: TaskEvent[] = [];
  #paused = false;
  /** Members who are not ready. */
  #missing: readonly string[];
  end: TaskEnd | null = null;
  /** The match is gone, and with it the trial's result. */
  interrupted = false;

  /**
   * members: of the participant's group. joinsLate: the match ran before this trial was started: they were in it
   * before, and it is the rest of it that counts.
   */
  constructor(
    private readonly task: MatchTask<Game>,
    private readonly seconds: number,
    private readonly members: readonly string[],
    private readonly joinsLate: boolean,
  ) {
    this.#missing = members;
  }

  /** `getReady`: asks the room to count this participant as ready. */
  played(frame: MatchFrame<Game>, getReady: () => void): void {
    if (this.end || this.interrupted) return;
    const { state, connection } = frame;
    const over = state.phase === 'over';
    // A match that the room has forgotten or disconnected has no result.
    const began = this.#from !== null;
    this.interrupted = (began && frame.epoch !== this.#epoch) || (connection === 'ended' && !(began && over));
    if (this.interrupted) return;
    this.#paused = frame.paused;
    if (this.#from === null) this.#begin(frame, getReady);
    if (this.#from !== null) this.#follow(frame, frame.time - this.#from);
  }

  #begin({ state, me, players, time, epoch }: MatchFrame<Game>, getReady: () => void): void {
    const there = players.flatMap((player) => (player?.ready ? [player.name] : []));
    this.#missing = this.members.filter((name) => !there.includes(name));
    if (state.phase === 'running') {
      // However late this page draws its first frame of the match.
      this.#from = this.joinsLate ? time : (this.task.figures(state).startedAt ?? time);
      this.#epoch = epoch;
    } else if (me !== null && !state.players[me]?.ready) {
      // The room may have forgotten: a server that was restarted, a seat that was only now given.
      getReady();
    }
  }

  /** since: the trial's beginning [s]. */
  #follow({ state, connection, me, events }: MatchFrame<Game>, since: number): void {
    const at = Math.max(0, since);
    this.#happened.push(...events.flatMap((event) => this.task.taskEvents(event, me, at)));
    const figures = this.task.figures(state);
    // If the room's own bell rings no later, it decides: a ball may still be in the air.
    const limit = figures.seconds <= this.seconds ? this.seconds + bellDelay : this.seconds;
    const over = state.phase === 'over';
    // Without a connection this page does not know the score: it waits for the connection.
    if (!over && (at < limit || connection !== 'joined')) return;
    this.end = {
      seconds: Math.min(at, limit),
      ended: (over && figures.end) || 'time',
      score: figures.score,
      maximum: figures.of,
    };
  }

  take(): TaskEvent[] {
    const taken = this.#happened;
    this.#happened = [];
    return taken;
  }

  get waitingFor(): readonly string[] | null {
    return this.#from !== null || this.end || this.interrupted ? null : this.#missing;
  }

  get standing(): boolean {
    return this.#paused && this.end === null;
  }
}

/** Makes a game of several people a task of a study. */
export function createMatchRunner<Game extends HostedGame>(
  task: MatchTask<Game>,
  services: RunnerServices<StudiedMatch<Game>>,
): ActivityRunner {
  let place: TaskPlace | null = null;
  let trial: MatchTrial<Game> | null = null;
  const play = () => services.opened()?.play;
  const getReady = () => play()?.connection?.setReady(true);

  return {
    async prepare(next) {
      place = next;
      if (!(await services.open(next))) throw new PhrasedError(`round.${task.name}`);
    },
    start({ seconds }) {
      const match = play();
      trial = new MatchTrial(task, seconds, place?.members ?? [], match?.room?.match?.phase === 'running');
      // The room still applies the pause that this page requested before it was reloaded.
      match?.connection?.setPaused(false);
      match?.connection?.setReady(true);
    },
    played() {
      const newest = play()?.newest;
      if (newest) trial?.played(newest, getReady);
    },
    take: () => trial?.take() ?? [],
    get end() {
      return trial?.end ?? null;
    },
    get waitingFor() {
      return trial?.waitingFor ?? null;
    },
    get pausedByOther() {
      return trial?.standing ?? false;
    },
    get interrupted() {
      return trial?.interrupted ?? false;
    },
    pause: (on) => play()?.connection?.setPaused(on),
    abort() {
      trial = null;
      services.leave();
    },
    assists: () => [],
  };
}
