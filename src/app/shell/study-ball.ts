import type { BallFrame } from '../ball/ball-frame';
import type { BallPlay } from '../ball/ball-play';
import type { TaskEnd, TaskEvent, TaskPlace, TaskRunner } from '../study/task-runner';

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

export function createBallRunner(host: BallHost): BallRunner {
  let place: TaskPlace | null = null;
  let wanted: { readonly seconds: number } | null = null;
  /** The match ran before this participant's trial was started: they were in it before, and it is the rest of it that counts. */
  let joinsLate = false;
  /** Second of the match at which this participant's trial began; null: not yet. */
  let from: number | null = null;
  /** The room that it began in. */
  let epoch = '';
  let end: TaskEnd | null = null;
  let interrupted = false;
  let happened: TaskEvent[] = [];
  let missing: readonly string[] = [];
  let standing = false;
  const forget = () => {
    happened = [];
    end = null;
    interrupted = false;
    from = null;
    standing = false;
  };

  return {
    async prepare(next) {
      place = next;
      await host.goToBall(next);
    },
    start({ seconds }) {
      forget();
      wanted = { seconds };
      missing = place?.members ?? [];
      const ball = host.ball();
      joinsLate = ball?.room?.match?.phase === 'running';
      // The seat still wants what this page wanted before it was loaded again, which may have been a pause.
      ball?.pause(false);
      ball?.ready(true);
    },
    played({ state, connection, me, players, events, time, paused, ...frame }) {
      if (!wanted || end) return;
      const over = state.phase === 'over';
      // A match that the room has forgotten, or that is told of no more, has no result.
      interrupted = (from !== null && frame.epoch !== epoch) || (connection === 'ended' && !(from !== null && over));
      if (interrupted) {
        wanted = null;
        return;
      }
      standing = paused;
      if (from === null) {
        const there = players.flatMap((player) => (player?.ready ? [player.name] : []));
        missing = (place?.members ?? []).filter((name) => !there.includes(name));
        // The room may have forgotten: a server that was restarted, a seat that was only now given.
        if (me !== null && state.phase !== 'running' && !state.players[me]?.ready) host.ball()?.ready(true);
        if (state.phase !== 'running') return;
        // However late this page draws its first frame of the match.
        from = joinsLate ? time : (state.startedAt ?? time);
        epoch = frame.epoch;
      }
      const at = Math.max(0, time - from);
      happened.push(...events.flatMap((event) => taskEvents(event, me, at)));
      // Where the room's own bell rings no later, its word is the last one: a ball may still be in the air.
      const limit = state.options.seconds <= wanted.seconds ? wanted.seconds + bellDelay : wanted.seconds;
      // A page that does not hear the room does not know the score: it waits for its return.
      if (!over && (at < limit || connection !== 'joined')) return;
      end = {
        seconds: Math.min(at, limit),
        ended: (over && state.end) || 'time',
        score: state.score,
        maximum: state.options.balls,
      };
      wanted = null;
    },
    take() {
      const taken = happened;
      happened = [];
      return taken;
    },
    get end() {
      return end;
    },
    get waitingFor() {
      return !wanted || from !== null ? null : missing;
    },
    get standing() {
      return standing && end === null;
    },
    get interrupted() {
      return interrupted;
    },
    pause: (on) => host.ball()?.pause(on),
    abort() {
      wanted = null;
      forget();
      host.leaveBall();
    },
    assists: () => [],
  };
}
