import { fullScore, matchTime } from 'threepoint-games/archery';
import { PhrasedError } from 'threepoint-study';
import type { TaskEnd, TaskEvent } from 'threepoint-study/participant';
import type { ActivityRunner, RunnerServices } from '../activity/activity';
import type { ArcheryFrame } from './archery-play';

/** The parts of archery that a study uses. */
interface StudiedArchery {
  readonly play: { readonly newest: ArcheryFrame | null };
  /** Starts a round by its signal, with this layout and length [s]. */
  startRound(layout: number, seconds: number): void;
  /** Replaces the round by one that waits for its start. */
  resetRound(): void;
}

/** Archery as a task of a study. */
export function createArcheryRunner(services: RunnerServices<StudiedArchery>): ActivityRunner {
  let running = false;
  let end: TaskEnd | null = null;
  let happened: TaskEvent[] = [];

  function observe({ state, events }: ArcheryFrame): void {
    for (const event of events) {
      if (event.type === 'released') happened.push({ type: 'shot' });
      if (event.type === 'landed') {
        const { time, points, target } = event.landing;
        happened.push({ type: target === null ? 'miss' : 'hit', time: Math.max(0, time), points });
      }
      if (event.type === 'ended') {
        running = false;
        end = { seconds: matchTime(state), ended: event.end, score: event.score, maximum: fullScore(state) };
      }
    }
  }

  return {
    async prepare(place) {
      services.writer.change({ seconds: place.seconds });
      const archery = services.opened() ?? (await services.open(place));
      if (!archery) throw new PhrasedError('round.archery');
      archery.resetRound();
    },
    start({ seed, seconds }) {
      happened = [];
      end = null;
      running = true;
      services.opened()?.startRound(seed, seconds);
    },
    played() {
      const newest = services.opened()?.play.newest;
      if (running && newest) observe(newest);
    },
    take() {
      const taken = happened;
      happened = [];
      return taken;
    },
    waitingFor: null,
    pausedByOther: false,
    interrupted: false,
    pause: () => undefined,
    get end() {
      return end;
    },
    abort() {
      running = false;
      end = null;
      happened = [];
      services.opened()?.resetRound();
    },
    assists: () => (services.settings.oneHanded ? ['one hand'] : []),
  };
}
