import { pageElement } from './element';

/** Something that must load before the first body is drawn, and its share of the progress. */
export interface LoadingStep {
  readonly name: string;
  readonly weight: number;
}

/** The bar that index.html shows from the first paint until everything has been loaded. */
export function createProgress(steps: readonly LoadingStep[]) {
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
    /** How far a step is, 0 to 1; never goes back. */
    report(step: string, part: number): void {
      parts.set(step, Math.min(1, Math.max(parts.get(step) ?? 0, part)));
      show();
    },
    /** The first body is drawn: further loading is shown as a thin bar above the picture. */
    showBody(): void {
      document.body.classList.add('loaded');
    },
    /** Everything has been loaded, or has failed: hides the bar. */
    finish(): void {
      region.hidden = true;
      document.body.classList.add('loaded');
    },
  };
}

export type Progress = ReturnType<typeof createProgress>;
