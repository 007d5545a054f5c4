import { allReleased, type Buttons } from 'threepoint/core';
import { ballTask } from '../../../src/page/ball/ball-task';
import type { BallPlay } from '../../../src/page/ball/match/ball-play';
import { createMatchRunner } from '../../../src/page/people/match/match-runner';
import { LossyWire } from '../../rooms/client/lossy-wire';
import { fists, holding, opening, releaseOf, shownAt } from '../../rooms/client/people';
import { createTestRoom } from '../../rooms/room/test-room';
import {
  type GroupPlan,
  type GroupRecord,
  type GroupSession,
  groupIn,
  groupSession,
} from '../../study/model/group-sessions';
import { trialOf } from '../../study/participant/played-trial';
import { activityServices } from '../activity-services';
import { ballPage } from '../playing';

type Trial = ReturnType<typeof trialOf>;

const released: Buttons = { left: allReleased, right: allReleased };
const wristsOn = (seat: number) => (seat === 2 ? holding(opening) : fists(releaseOf(seat)));
/** The frames of a page per second. */
const rateHz = 10;
/** The time from a reload, or from the sheet after an interruption, to the press on Start [s]. */
const startsAfter = 1;

/** A page of a participant of the group, from the sheet before the match to the step after it. */
class GroupPage {
  readonly participant: string;
  readonly #plan: GroupPlan;
  readonly #room: ReturnType<typeof createTestRoom>;
  readonly #seat: number;
  readonly #session: GroupSession;
  readonly #step: string;
  #pages = 0;
  #wire!: LossyWire;
  #play!: BallPlay;
  #runner!: ReturnType<typeof createMatchRunner>;
  #trial: Trial | null = null;
  #startAt = 0;
  #isHere = true;

  /** `othersAreOver`: whether another of the group has gone on from the trial. */
  constructor(
    plan: GroupPlan,
    participant: string,
    room: ReturnType<typeof createTestRoom>,
    private readonly othersAreOver: () => boolean,
  ) {
    this.#plan = plan;
    this.participant = participant;
    this.#room = room;
    this.#seat = groupIn(plan).members.indexOf(participant);
    this.#session = groupSession(plan, participant);
    this.#step = this.#session.step.id;
    this.#open();
  }

  get records(): readonly GroupRecord[] {
    return this.#session.records;
  }

  /** Whether the participant has gone on from the trial. */
  get isOver(): boolean {
    return this.#session.step.id !== this.#step;
  }

  get standing(): boolean {
    return this.#trial?.runner.pausedByOther ?? false;
  }

  get awaited() {
    return this.#runner.awaited;
  }

  get attempt(): number {
    return this.#session.progress.attempt;
  }

  /** The connection is lost, and the server notices. */
  lose(): void {
    this.#wire.lose();
    this.#isHere = false;
  }

  /** The page draws and sends nothing, as with a network that drops what it should carry. */
  fallSilent(): void {
    this.#isHere = false;
  }

  comeBack(): void {
    if (this.#isHere) return;
    this.#isHere = true;
    if (this.#wire.status.phase !== 'joined') this.#wire.connect();
  }

  /** The page is closed, and opened again later by `loadAgain`. */
  close(): void {
    this.lose();
    this.#trial = null;
  }

  loadAgain(): void {
    this.#isHere = true;
    if (!this.isOver) this.#apply({ type: 'reload' });
    this.#open();
  }

  frame(time: number): void {
    if (!this.#isHere || this.isOver) return;
    this.#play.begin(time);
    this.#play.follow(time, null, released);
    this.#wire.sendPose(time, shownAt(this.#wire, this.#seat, wristsOn(this.#seat)));
    this.#runner.played();
    if (!this.#trial && time >= this.#startAt) this.#start();
    // The server answers so to a page that asks for its seat.
    if (this.#trial?.runner.waitingFor && this.othersAreOver()) this.#apply({ type: 'missed' });
    this.#followTrial(time);
  }

  #followTrial(time: number): void {
    const trial = this.#trial;
    if (!trial) return;
    for (const absence of trial.runner.takeAbsences?.() ?? []) this.#apply({ type: 'absence', absence });
    if (trial.runner.interrupted) {
      this.#apply({ type: 'reload' });
      trial.abort();
      this.#trial = null;
      this.#open();
      return;
    }
    const finished = trial.follow(time, null);
    if (finished) this.#apply({ type: 'trial-finished', outcome: finished.outcome });
  }

  #open(): void {
    this.#pages += 1;
    this.#startAt = this.#room.time + startsAfter;
    this.#wire = new LossyWire(this.#room, 100 * this.#pages, { name: this.participant, seat: this.#seat });
    const wire = this.#wire;
    const play = ballPage({ connect: () => wire }, { name: this.participant, seat: this.#seat, seed: 7 });
    this.#play = play;
    const { settings, writer } = activityServices();
    this.#runner = createMatchRunner(ballTask, {
      settings,
      writer,
      opened: () => ({ play }),
      open: async () => ({ play }),
      leave: () => play.leave(),
    });
    const { task, members, after } = groupIn(this.#plan);
    void this.#runner.prepare({
      ...{ participant: this.participant, members, seconds: task.trialSeconds },
      seat: async () => ({ room: 'here', token: '' }),
      afterAbsence: after,
    });
  }

  #start(): void {
    const { trialSeconds: seconds } = groupIn(this.#plan).task;
    this.#apply({ type: 'start' });
    this.#trial = trialOf(this.#runner, { task: 'ball', seconds, key: `${this.attempt}` });
  }

  #apply(event: Parameters<GroupSession['tell']>[0]): void {
    const refusal = this.#session.tell(event);
    if (refusal !== null) throw new Error(`${this.participant}: ${refusal}`);
  }
}

/** Three pages of one group in the room of their first ball match. */
export async function groupOfPages(plan: GroupPlan) {
  const { task, members, waitSeconds } = groupIn(plan);
  const room = createTestRoom({
    ...{ assigned: true, pausable: true },
    ball: { everySeat: true, seconds: task.trialSeconds, waitSeconds },
  });
  const pages: GroupPage[] = members.map(
    (participant) => new GroupPage(plan, participant, room, () => pages.some(({ isOver }) => isOver)),
  );
  // The runners are prepared after a turn of the event loop.
  await new Promise((resolve) => setTimeout(resolve));
  let startedAt: number | null = null;
  let endedAt: number | null = null;
  return {
    room,
    pages,
    pageOf: (seat: number) => pages[seat] as GroupPage,
    /** Seconds from the start of the match that ended last to its end, by the clock of the wall; null: none ended. */
    get wallSeconds(): number | null {
      return startedAt === null || endedAt === null ? null : endedAt - startedAt;
    },
    get records(): readonly GroupRecord[] {
      return pages.flatMap((page) => page.records);
    },
    get isOver(): boolean {
      return pages.every((page) => page.isOver);
    },
    async pass(seconds: number): Promise<void> {
      for (let i = 0; i < Math.round(seconds * rateHz); i++) {
        for (let tick = 0; tick < 60 / rateHz; tick++) {
          const before = room.room.match.phase;
          room.tick();
          const { phase } = room.room.match;
          if (before !== 'running' && phase === 'running') startedAt = room.time;
          if (before === 'running' && phase !== 'running') endedAt = room.time;
        }
        for (const page of pages) page.frame(room.time);
        await Promise.resolve();
      }
    },
  };
}
