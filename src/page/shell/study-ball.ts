import type { TaskEnd, TaskEvent, TaskPlace, TaskRunner } from 'threepoint-study/participant/task-runner';
import type { BallFrame } from '../ball/ball-frame';
import type { BallPlay } from '../ball/ball-play';

/** What the study needs of the ball game on the page. */
export interface BallHost {
  /** The court in this room of the relay, on this seat. */
  goToBall(place: TaskPlace): Promise<void>;
  /** The match on the page; null: this page is not at the court. */
  ball(): BallPlay | null;
  leaveBall(): void;
}

/** The ball game as a task of a study; `played` hears every frame of the match on the page. */
export interface BallRunner extends TaskRunner {
  played(frame: BallFrame): void;
}

/** How much later than here the room's bell may be heard [s]: the room counts from the moment it started the match. */
const bellDelay = 4;

/** What an event of the match is for the participant on this seat, at this second of their trial. */
function taskEvents(event: BallFrame['events'][number], me: number | null, at: number): TaskEvent[] {
  if (event.type === 'thrown' && event.player === me) return [{ type: 'shot' }];
  if (event.type === 'missed' && event.player === me) return [{ type: 'miss', time: at, points: 0 }];
  // A point is the group's: it is a hit of the thrower, and a catch for the others.
  if (event.type === 'caught') return [{ type: event.player === me ? 'hit' : 'catch', time: at, points: 1 }];
  return [];
}

/** One participant's trial: which part of the match on the page counts for it, what happens to them there, and how it ends. */
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
   * members: of the participant's group. joinsLate: the match ran before this trial was started: they were in it before, and it is the rest
   * of it that counts.
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
    // A match that the room has forgotten, or that is told of no more, has no result.
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
    // Where the room's own bell rings no later, its word is the last one: a ball may still be in the air.
    const limit = state.options.seconds <= this.seconds ? this.seconds + bellDelay : this.seconds;
    const over = state.phase === 'over';
    // A page that does not hear the room does not know the score: it waits for its return.
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

export function createBallRunner(host: BallHost): BallRunner {
  let place: TaskPlace | null = null;
  let trial: BallTrial | null = null;
  const getReady = () => host.ball()?.ready(true);

  return {
    async prepare(next) {
      place = next;
      await host.goToBall(next);
    },
    start({ seconds }) {
      const ball = host.ball();
      trial = new BallTrial(seconds, place?.members ?? [], ball?.room?.match?.phase === 'running');
      // The seat still wants what this page wanted before it was loaded again, which may have been a pause.
      ball?.pause(false);
      ball?.ready(true);
    },
    played: (frame) => trial?.played(frame, getReady),
    take: () => trial?.take() ?? [],
    get end() {
      return trial?.end ?? null;
    },
    get waitingFor() {
      return trial?.waitingFor ?? null;
    },
    get standing() {
      return trial?.standing ?? false;
    },
    get interrupted() {
      return trial?.interrupted ?? false;
    },
    pause: (on) => host.ball()?.pause(on),
    abort() {
      trial = null;
      host.leaveBall();
    },
    assists: () => [],
  };
}
