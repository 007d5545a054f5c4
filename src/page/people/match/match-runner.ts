import type { GameName } from 'threepoint-games/all';
import type { SeenAbsence } from 'threepoint-rooms/internal';
import type { HostedGame, RoomView } from 'threepoint-rooms/room';
import { PhrasedError } from 'threepoint-study';
import type { Awaited, TaskEnd, TaskEvent, TaskPlace, TrialAbsence } from 'threepoint-study/participant';
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
  /** Second of the match at which the trial began; null: not yet. */
  #from: number | null = null;
  /** Second of the match at which the room started it. */
  #startedAt = 0;
  /** The room that it began in. */
  #epoch = '';
  #happened: TaskEvent[] = [];
  #paused = false;
  /** Members who are not ready. */
  #missing: readonly string[];
  /** The newest absence of an earlier match. */
  #earlierAbsence = 0;
  /** The newest absence that was passed on, or that ended before this trial was started. */
  #lastAbsence: number;
  #welcomes: number;
  /** Second at which the room started the match that ran when this trial was started; null: none ran. */
  readonly #joinedLate: number | null;
  /** The figures of the newest frame of the match. */
  #newest: Pick<TaskEnd, 'seconds' | 'score' | 'maximum'> = { seconds: 0, score: 0, maximum: 1 };
  end: TaskEnd | null = null;
  /** The match is gone, and with it the trial's result. */
  interrupted = false;

  /**
   * `room`: as it is when the trial starts. If its match runs then, the participant was in it before, and this trial is
   * the rest of it.
   */
  constructor(
    private readonly task: MatchTask<Game>,
    private readonly seconds: number,
    private readonly place: TaskPlace,
    room: RoomView<Game> | null,
  ) {
    this.#missing = place.members;
    this.#welcomes = room?.welcomeCount ?? 0;
    this.#lastAbsence = room?.absences.findLast(({ seconds }) => seconds !== null)?.number ?? 0;
    this.#joinedLate = room?.match?.phase === 'running' ? task.figures(room.match).startedAt : null;
  }

  /** `getReady`: asks the room to count this participant as ready. */
  played(frame: MatchFrame<Game>, room: RoomView<Game>, getReady: () => void): void {
    if (room.welcomeCount !== this.#welcomes) {
      // The room waits until a participant whose connection was lost is ready again.
      this.#welcomes = room.welcomeCount;
      getReady();
    }
    if (this.end || this.interrupted) return;
    const { state, connection } = frame;
    const over = state.phase === 'over';
    // A match that the room has forgotten or disconnected has no result.
    const began = this.#from !== null;
    this.interrupted = (began && frame.epoch !== this.#epoch) || (connection === 'ended' && !(began && over));
    if (this.interrupted) return;
    if (began && (state.phase === 'ready' || this.task.figures(state).startedAt !== this.#startedAt)) {
      this.#giveUp(room);
      return;
    }
    this.#paused = frame.paused;
    if (this.#from === null) this.#begin(frame, room, getReady);
    if (this.#from !== null) this.#follow(frame, room);
  }

  /** The room has given up the match, because a participant was away for too long. */
  #giveUp(room: RoomView<Game>): void {
    if (this.place.afterAbsence === 'repeat') this.interrupted = true;
    else this.#end('absence', room);
  }

  #end(ended: TaskEnd['ended'], { absences }: RoomView<Game>): void {
    this.end = { ...this.#newest, ...this.#late, ended, absences: this.#endedAfter(this.#earlierAbsence, absences) };
  }

  #begin({ state, me, players, time, epoch }: MatchFrame<Game>, room: RoomView<Game>, getReady: () => void): void {
    const there = players.flatMap((player) => (player?.ready ? [player.name] : []));
    this.#missing = this.place.members.filter((name) => !there.includes(name));
    if (state.phase === 'running') {
      this.#startedAt = this.task.figures(state).startedAt ?? time;
      // However late this page draws its first frame of the match.
      this.#from = this.#joinedLate === this.#startedAt ? time : this.#startedAt;
      this.#earlierAbsence = room.absences.findLast(({ givenUp }) => givenUp)?.number ?? 0;
      this.#epoch = epoch;
    } else if (me !== null && !state.players[me]?.ready) {
      // The room may have forgotten: a server that was restarted, a seat that was only now given.
      getReady();
    }
  }

  /** The second of the match at which a trial in a match that ran before began. */
  get #late(): Pick<TaskEnd, 'from'> {
    const from = (this.#from ?? 0) - this.#startedAt;
    return from > 0 ? { from } : {};
  }

  #follow({ state, connection, me, events, time }: MatchFrame<Game>, room: RoomView<Game>): void {
    const at = Math.max(0, time - (this.#from ?? time));
    this.#happened.push(...events.flatMap((event) => this.task.taskEvents(event, me, at)));
    const figures = this.task.figures(state);
    // If the room's own bell rings no later, it decides: a ball may still be in the air.
    const seconds = this.seconds - (this.#late.from ?? 0);
    const limit = figures.seconds <= this.seconds ? seconds + bellDelay : seconds;
    const over = state.phase === 'over';
    this.#newest = { seconds: Math.min(at, limit), score: figures.score, maximum: figures.of };
    // Without a connection this page does not know the score: it waits for the connection.
    if (!over && (at < limit || connection !== 'joined')) return;
    this.#end((over && figures.end) || 'time', room);
  }

  take(): TaskEvent[] {
    const taken = this.#happened;
    this.#happened = [];
    return taken;
  }

  /** Returns the absences of its match that ended since the trial was started and since the last call. */
  takeAbsences(absences: readonly SeenAbsence[]): readonly TrialAbsence[] {
    if (this.#from === null) return [];
    const taken = this.#endedAfter(Math.max(this.#lastAbsence, this.#earlierAbsence), absences);
    this.#lastAbsence = absences.findLast(({ seconds }) => seconds !== null)?.number ?? 0;
    return taken;
  }

  #endedAfter(last: number, absences: readonly SeenAbsence[]): readonly TrialAbsence[] {
    return absences.flatMap(({ number, seats, at, seconds, givenUp }) => {
      if (seconds === null || number <= last) return [];
      const participants = membersOn(seats, this.place);
      return [{ participants, time: Math.max(0, at - this.#startedAt), seconds, givenUp }];
    });
  }

  /** The second of the match; null: it has not begun. */
  get second(): number | null {
    return this.#from === null ? null : this.#newest.seconds + (this.#late.from ?? 0);
  }

  get waitingFor(): readonly string[] | null {
    return this.#from !== null || this.end || this.interrupted ? null : this.#missing;
  }

  get standing(): boolean {
    return this.#paused && this.end === null;
  }
}

/** Returns the codes of the participants on these seats. */
const membersOn = (seats: readonly number[], { members }: Pick<TaskPlace, 'members'>): string[] =>
  seats.flatMap((seat) => members[seat] ?? []);

/** Returns the absent participants of a match that stands now; null: it does not stand for any. */
function awaitedIn(room: RoomView<HostedGame>, place: TaskPlace): Awaited | null {
  const open = room.absences.at(-1);
  if (open?.seconds !== null) return null;
  const away = open.seats.filter((seat) => room.seats[seat]?.presence !== 'here');
  return { participants: membersOn(away.length > 0 ? away : open.seats, place), secondsLeft: open.secondsLeft };
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
      if (!place) throw new Error('a trial was started before it was prepared');
      const match = play();
      trial = new MatchTrial(task, seconds, place, match?.room ?? null);
      // The room still applies the pause that this page requested before it was reloaded.
      match?.connection?.setPaused(false);
      match?.connection?.setReady(true);
    },
    played() {
      const match = play();
      if (match?.newest && match.room) trial?.played(match.newest, match.room, getReady);
    },
    take: () => trial?.take() ?? [],
    takeAbsences: () => trial?.takeAbsences(play()?.room?.absences ?? []) ?? [],
    get awaited() {
      const room = play()?.room;
      return room && place ? awaitedIn(room, place) : null;
    },
    get second() {
      return trial?.second ?? null;
    },
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
