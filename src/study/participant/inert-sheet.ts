import type { StudyScreen } from './questions/study-screen';

/** For how long a sheet that the participant did not call for takes no press [s]. */
export const inertSeconds = 1;
/** A sheet that appears within this time of its cause follows from it [s]. */
const causeSeconds = 0.5;

/**
 * Keeps a press that was meant for one sheet from the next one: the buttons of a sheet that the experimenter, the clock
 * or the group brought are off for a moment.
 */
export class InertSheet {
  readonly #now: () => number;
  #shown: string | null = null;
  #causedAt = Number.NEGATIVE_INFINITY;
  #until = Number.NEGATIVE_INFINITY;

  /** `now` returns seconds since 1970. */
  constructor(now: () => number) {
    this.#now = now;
  }

  /** Called when something other than the participant is about to change the sheet. */
  expectChange(): void {
    this.#causedAt = this.#now();
  }

  shown(screen: StudyScreen | null): StudyScreen | null {
    const now = this.#now();
    const id = screen?.id ?? null;
    if (id !== this.#shown && now - this.#causedAt < causeSeconds) this.#until = now + inertSeconds;
    this.#shown = id;
    if (!screen || now >= this.#until) return screen;
    return { ...screen, buttons: screen.buttons.map((button) => ({ ...button, look: 'off' })) };
  }
}
