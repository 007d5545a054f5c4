import { createProgress, type Progress } from 'threepoint-ui/progress-bar';

/** The page until it shows the first body: the progress bar, and the time of each step for tools. */
export class PageLoading {
  readonly #progress: Progress = createProgress([
    { name: 'the avatar', weight: 3 },
    { name: 'the network', weight: 3 },
    { name: 'the first picture', weight: 1 },
  ]);
  readonly #marks: Record<string, number> = {};
  #ready = false;

  /** Everything has been loaded, or has failed. */
  get ready(): boolean {
    return this.#ready;
  }

  /** Milliseconds from opening the page to each mark. */
  get marks(): Readonly<Record<string, number>> {
    return this.#marks;
  }

  mark(name: string): void {
    this.#marks[name] ??= Math.round(performance.now());
  }

  /** How much of a step is done, 0 to 1. */
  report(step: 'the avatar' | 'the network' | 'the first picture', part: number): void {
    this.#progress.report(step, part);
  }

  /** The first body is on the screen. */
  bodyShown(): void {
    this.report('the first picture', 1);
    this.#progress.showBody();
    this.mark('firstBody');
  }

  finish(): void {
    this.mark('estimator');
    this.#progress.finish();
    this.#ready = true;
  }
}
