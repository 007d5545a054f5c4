import { fullScore, matchTime } from 'threepoint-games/archery/rules';
import type { TaskEnd, TaskEvent, TaskRunner } from 'threepoint-study/participant/task-runner';
import type { ArcheryFrame } from '../archery/archery-play';

/** What the study needs of the archery on the page. */
export interface ArcheryHost {
  /** The range, where a round of so many seconds waits. */
  goToArchery(seconds: number): Promise<void>;
  /** A new round that starts with its signal. */
  startRound(seed: number, seconds: number): void;
  /** Makes the round on the page one that waits. */
  resetRound(): void;
  assists(): readonly string[];
}

/** Archery as a task of a study; `played` hears every frame of the round on the page. */
export interface ArcheryRunner extends TaskRunner {
  played(frame: ArcheryFrame): void;
}

export function createArcheryRunner(host: ArcheryHost): ArcheryRunner {
  let running = false;
  let end: TaskEnd | null = null;
  let happened: TaskEvent[] = [];
  return {
    prepare: ({ seconds }) => host.goToArchery(seconds),
    start({ seed, seconds }) {
      happened = [];
      end = null;
      running = true;
      host.startRound(seed, seconds);
    },
    played({ state, events }) {
      if (!running) return;
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
    },
    take() {
      const taken = happened;
      happened = [];
      return taken;
    },
    waitingFor: null,
    standing: false,
    interrupted: false,
    pause: () => undefined,
    get end() {
      return end;
    },
    abort() {
      running = false;
      end = null;
      happened = [];
      host.resetRound();
    },
    assists: () => host.assists(),
  };
}
