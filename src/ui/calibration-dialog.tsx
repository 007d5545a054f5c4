import type { CalibrationFault } from 'threepoint/core';
import { Button, openModal } from './controls';

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

interface CalibrationDialogProps {
  readonly step: CalibrationStep;
  readonly cancel: () => void;
  readonly again: () => void;
}

/**
 * The dialog of the guided calibration: an instruction, a countdown, then a bar that fills. A modal dialog; Escape
 * and the button cancel.
 */
export function CalibrationDialog({ step, cancel, again }: CalibrationDialogProps) {
  const isOver = step.kind === 'done' || step.kind === 'failed';
  const onCancel = (event: Event) => {
    event.preventDefault();
    cancel();
  };
  return (
    <dialog
      ref={openModal}
      class="calibration-dialog"
      aria-labelledby="calibration-title"
      data-step={step.kind}
      onCancel={onCancel}
    >
      <h2 id="calibration-title">Calibrate</h2>
      <p>{isOver ? step.text : calibrationInstruction}</p>
      <p class="countdown" role="status">
        {calibrationHeadline(step)}
      </p>
      <progress max={1} value={step.kind === 'measuring' ? step.part : isOver ? 1 : 0} aria-label="Measuring" />
      <div class="row">
        {step.kind === 'failed' && <Button label="Try again" class="primary" onClick={again} />}
        <Button label={isOver ? 'Close' : 'Cancel'} onClick={cancel} />
      </div>
    </dialog>
  );
}
