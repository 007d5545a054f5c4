import { pageElement } from 'threepoint-ui';

/** What loads, in this order, and its share of the progress. */
const steps = [
  { name: 'the avatar', weight: 3 },
  { name: 'the first picture', weight: 1 },
  { name: 'the network', weight: 3 },
] as const;
type StepName = (typeof steps)[number]['name'];

const total = steps.reduce((sum, { weight }) => sum + weight, 0);

/**
 * The page until it shows the first body: the bar that index.html shows from the first paint until everything has been
 * loaded, and the time of each step for tools.
 */
export class PageLoading {
  readonly #region = pageElement('progress', HTMLDivElement);
  readonly #text = pageElement('progress-text', HTMLParagraphElement);
  readonly #bar = pageElement('progress-bar', HTMLProgressElement);
  readonly #parts: Record<StepName, number> = { 'the avatar': 0, 'the first picture': 0, 'the network': 0 };
  readonly #marks: Record<string, number> = {};

  constructor() {
    this.#show();
  }

  /** Everything has been loaded, or has failed. */
  get ready(): boolean {
    return this.#region.hidden;
  }

  /** Milliseconds from opening the page to each mark. */
  get marks(): Readonly<Record<string, number>> {
    return this.#marks;
  }

  mark(name: string): void {
    this.#marks[name] ??= Math.round(performance.now());
  }

  /** Reports how much of a step is done, 0 to 1; never goes back. */
  report(step: StepName, part: number): void {
    this.#parts[step] = Math.min(1, Math.max(this.#parts[step], part));
    this.#show();
  }

  /** The first body is on the screen: further loading is shown as a thin bar above the picture. */
  bodyShown(): void {
    this.report('the first picture', 1);
    document.body.classList.add('loaded');
    this.mark('firstBody');
  }

  finish(): void {
    this.mark('estimator');
    this.#region.hidden = true;
  }

  #show(): void {
    const done = steps.reduce((sum, { name, weight }) => sum + weight * this.#parts[name], 0);
    const next = steps.find(({ name }) => this.#parts[name] < 1);
    this.#bar.value = done / total;
    this.#text.textContent = next ? `Loading ${next.name} …` : 'Ready';
  }
}
