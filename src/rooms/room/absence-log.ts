import type { Absence } from '../protocol/messages';

/** The most absences that a client receives after it has joined. */
const maxReported = 32;

/** What decides how long a match waits at one moment. */
interface Moment {
  /** Room time [s]. */
  readonly time: number;
  /** The second of the match at which its clock stands. */
  readonly at: number;
  /** Whether a player requests a pause, during which no match is given up. */
  readonly isHeld: boolean;
}

const rounded = (seconds: number): number => Math.round(1000 * seconds) / 1000;

/** The absences for which the matches of one room have waited, and the limit of the present one. */
export class AbsenceLog {
  readonly #waitSeconds: number;
  readonly #report: (absence: Absence) => void;
  readonly #absences: Absence[] = [];

  /** `waitSeconds`: the longest wait [s]. `report` is called with each absence that begins, changes or ends. */
  constructor(waitSeconds: number, report: (absence: Absence) => void) {
    this.#waitSeconds = waitSeconds;
    this.#report = report;
  }

  /** The newest absences, oldest first. */
  get newest(): readonly Absence[] {
    return this.#absences.slice(-maxReported);
  }

  /** Whether a match waits now. */
  get isOpen(): boolean {
    return this.#open !== null;
  }

  /**
   * Takes into account which seats are absent while the clock stands. Returns whether the match has waited too long,
   * which ends the absence.
   */
  follow(absent: readonly number[], { time, at, isHeld }: Moment): boolean {
    const open = this.#open;
    if (!open) {
      if (absent.length > 0) this.#begin(absent, { time, at, isHeld });
      return false;
    }
    const seconds = rounded(time - open.since);
    if (absent.length === 0) {
      this.#change({ ...open, seconds });
      return false;
    }
    const seats = [...new Set([...open.seats, ...absent])];
    const until = isHeld ? null : (open.until ?? this.#limitFrom(time));
    const givenUp = until !== null && time >= until;
    if (givenUp) this.#change({ ...open, seats, until, seconds, givenUp });
    else if (seats.length > open.seats.length || until !== open.until) this.#change({ ...open, seats, until });
    return givenUp;
  }

  get #open(): Absence | null {
    const last = this.#absences.at(-1);
    return last?.seconds === null ? last : null;
  }

  #limitFrom(time: number): number {
    return rounded(time + this.#waitSeconds);
  }

  #begin(seats: readonly number[], { time, at, isHeld }: Moment): void {
    const until = isHeld ? null : this.#limitFrom(time);
    const number = this.#absences.length + 1;
    const times = { at: rounded(at), since: rounded(time), until, seconds: null };
    this.#absences.push({ number, seats: [...seats], ...times, givenUp: false });
    this.#report(this.#absences.at(-1) as Absence);
  }

  #change(absence: Absence): void {
    this.#absences[absence.number - 1] = absence;
    this.#report(absence);
  }
}
