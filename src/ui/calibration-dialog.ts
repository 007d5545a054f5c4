import type { CalibrationFault } from 'threepoint/core';
import { button, element } from './element';

/**
 * countdown: seconds left until measuring. measuring: part of it done, 0 to 1. done, failed: a closing sentence, in
 * English.
 */
export type CalibrationStep =
  | { readonly kind: 'countdown'; readonly secondsLeft: number }
  | { readonly kind: 'measuring'; readonly part: number }
  | { readonly kind: 'done'; readonly text: string }
  | { readonly kind: 'failed'; readonly fault: CalibrationFault; readonly text: string };

export const calibrationInstruction =
  'Stand straight, look ahead, stretch both arms forward, or down and out by 45°, wrists straight.';

/** Returns the word or figure of a step, for the dialog and for the menu in the headset. */
export function calibrationHeadline(step: CalibrationStep): string {
  if (step.kind === 'countdown') return String(Math.ceil(step.secondsLeft));
  if (step.kind === 'measuring') return 'Hold still';
  return step.kind === 'done' ? 'Done' : 'Not yet';
}

/**
 * The dialog of the guided calibration: an instruction, a countdown, then a bar that fills. A modal dialog; Escape
 * and the button cancel.
 */
export function createCalibrationDialog(onCancel: () => void, onAgain: () => void) {
  const headline = element('p', { class: 'countdown', role: 'status' });
  const text = element('p', {}, calibrationInstruction);
  const bar = element('progress', { max: 1, value: 0, 'aria-label': 'Measuring' });
  const again = button('Try again', onAgain, { class: 'primary' });
  const cancel = button('Cancel', onCancel);
  const dialog = element(
    'dialog',
    { class: 'calibration-dialog', 'aria-labelledby': 'calibration-title' },
    element('h2', { id: 'calibration-title' }, 'Calibrate'),
    text,
    headline,
    bar,
    element('div', { class: 'row' }, again, cancel),
  );
  dialog.addEventListener('cancel', (event) => {
    event.preventDefault();
    onCancel();
  });
  document.body.append(dialog);
  return {
    show(step: CalibrationStep): void {
      const over = step.kind === 'done' || step.kind === 'failed';
      const figure = calibrationHeadline(step);
      if (headline.textContent !== figure) headline.textContent = figure;
      text.textContent = over ? step.text : calibrationInstruction;
      dialog.dataset.step = step.kind;
      bar.value = step.kind === 'measuring' ? step.part : over ? 1 : 0;
      again.hidden = step.kind !== 'failed';
      cancel.textContent = over ? 'Close' : 'Cancel';
      if (!dialog.open) dialog.showModal();
    },
    hide(): void {
      if (dialog.open) dialog.close();
    },
  };
}

export type CalibrationDialog = ReturnType<typeof createCalibrationDialog>;
