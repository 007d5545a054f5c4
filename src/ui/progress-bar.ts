import { pageElement } from './element';

/** What has to be there before the first body stands on the floor, and its share of the waiting. */
export interface LoadingStep {
  readonly name: string;
  readonly weight: number;
}

export interface Progress {
  /** How far a step is, 0 to 1; never goes back. */
  report(step: string, part: number): void;
  /** The first body is on the screen: what is still loading goes on as a thin bar above it. */
  showBody(): void;
  /** Everything asked for is there, or known not to come: the bar goes. */
  finish(): void;
}

/** The bar that is there from the first paint (index.html) until everything has arrived. */
export function createProgress(steps: readonly LoadingStep[]): Progress {
  const region = pageElement('progress', HTMLDivElement);
  const text = pageElement('progress-text', HTMLParagraphElement);
  const bar = pageElement('progress-bar', HTMLProgressElement);
  const parts = new Map(steps.map(({ name }) => [name, 0]));
  const total = steps.reduce((sum, { weight }) => sum + weight, 0);
  const show = () => {
    const done = steps.reduce((sum, { name, weight }) => sum + weight * (parts.get(name) ?? 0), 0);
    const next = steps.find(({ name }) => (parts.get(name) ?? 0) < 1);
    bar.value = done / total;
    text.textContent = next ? `Loading ${next.name} …` : 'Ready';
  };
  show();
  return {
    report(step, part) {
      parts.set(step, Math.min(1, Math.max(parts.get(step) ?? 0, part)));
      show();
    },
    showBody() {
      document.body.classList.add('loaded');
    },
    finish() {
      region.hidden = true;
      document.body.classList.add('loaded');
    },
  };
}
