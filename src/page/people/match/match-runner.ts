import { PhrasedError } from 'threepoint-study';
import type { TaskEnd, TaskEvent, TaskPlace } from 'threepoint-study/participant';
import type { ActivityRunner, RunnerServices } from '../../activity/activity';
import type { BallFrame } from '../../ball/match/ball-frame';
import type { BallPlay } from '../../ball/match/ball-play';

/** The part of the ball game that a study uses. */
export interface StudiedBall {
  readonly play: Pick<BallPlay, 'newest' | 'room' | 'ready' | 'pause'>;
}

/** The longest delay of the room's bell after this page's [s]: the room counts from the moment it started the match. */
const bellDelay = 4;

/** What an event of the match is for the participant on this seat, at this second of their trial. */
function taskEvents(event: BallFrame['events'][number], me: number | null, at: number): TaskEvent[] {
  if (event.type === 'thrown' && event.player === me) return [{ type: 'shot' }];
  if (event.type === 'missed' && event.player === me) return [{ type: 'miss', time: at, points: 0 }];
  // A point is the group's: it is a hit of the thrower, and a catch for the others.
  if (event.type === 'caught') return [{ type: event.player === me ? 'hit' : 'catch', time: at, points: 1 }];
  return [];
}

/**
 * One participant's trial: which part of the match on the page counts for it, what happens to them there, and how it
 * ends.
 */
class BallTrial {
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
    private readonly seconds: number,
    private readonly members: readonly string[],
    private readonly joinsLate: boolean,
  ) {
    this.#missing = members;
  }

  /** `getReady`: asks the room to count this participant as ready. */
  played(frame: BallFrame, getReady: () => void): void {
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

  #begin({ state, me, players, time, epoch }: BallFrame, getReady: () => void): void {
    const there = players.flatMap((player) => (player?.ready ? [player.name] : []));
    this.#missing = this.members.filter((name) => !there.includes(name));
    if (state.phase === 'running') {
      // However late this page draws its first frame of the match.
      this.#from = this.joinsLate ? time : (state.startedAt ?? time);
      this.#epoch = epoch;
    } else if (me !== null && !state.players[me]?.ready) {
      // The room may have forgotten: a server that was restarted, a seat that was only now given.
      getReady();
    }
  }

  /** since: the trial's beginning [s]. */
  #follow({ state, connection, me, events }: BallFrame, since: number): void {
    const at = Math.max(0, since);
    this.#happened.push(...events.flatMap((event) => taskEvents(event, me, at)));
    // If the room's own bell rings no later, it decides: a ball may still be in the air.
    const limit = state.options.seconds <= this.seconds ? this.seconds + bellDelay : this.seconds;
    const over = state.phase === 'over';
    // Without a connection this page does not know the score: it waits for the connection.
    if (!over && (at < limit || connection !== 'joined')) return;
    this.end = {
      seconds: Math.min(at, limit),
      ended: (over && state.end) || 'time',
      score: state.score,
      maximum: state.options.balls,
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

/** The ball game as a task of a study. */
export function createBallRunner(services: RunnerServices<StudiedBall>): ActivityRunner {
  let place: TaskPlace | null = null;
  let trial: BallTrial | null = null;
  const play = () => services.opened()?.play;
  const getReady = () => play()?.ready(true);

  return {
    async prepare(next) {
      place = next;
      if (!(await services.open(next))) throw new PhrasedError('round.ball');
    },
    start({ seconds }) {
      const match = play();
      trial = new BallTrial(seconds, place?.members ?? [], match?.room?.match?.phase === 'running');
      // The room still applies the pause that this page requested before it was reloaded.
      match?.pause(false);
      match?.ready(true);
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
    pause: (on) => play()?.pause(on),
    abort() {
      trial = null;
      services.leave();
    },
    assists: () => [],
  };
}
