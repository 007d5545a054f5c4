import { type GripOffset, type HandleFit, largestGripOffset } from 'threepoint/core';
import { type Side, sides } from 'threepoint/math';
import type { StageParts } from '../stage/stage-parts';

/** The hands whose grip is corrected at once. */
export type GripHands = Side | 'both';

export const gripHands = ['left', 'both', 'right'] as const satisfies readonly GripHands[];

export const handLabels: Readonly<Record<GripHands, string>> = { left: 'Left', both: 'Both', right: 'Right' };

/** A correction in steps to both sides of 0, in the words of what the drawn hand does. */
interface GripStep {
  readonly part: keyof HandleFit;
  readonly kind: 'Move' | 'Turn';
  /** What the hand does by a step back, and by a step on. */
  readonly less: string;
  readonly more: string;
  /** The change of the fit by a step on [m, rad]: a hand that moves forward has the grip nearer to its wrist. */
  readonly change: number;
}

const millimetres = 5;
const degrees = 3;
const [shift, turn] = [millimetres / 1000, (degrees * Math.PI) / 180];

const gripSteps: readonly GripStep[] = [
  { part: 'ahead', kind: 'Move', less: 'Back', more: 'Forward', change: -shift },
  { part: 'below', kind: 'Move', less: 'Down', more: 'Up', change: shift },
  { part: 'thumbward', kind: 'Move', less: 'Little finger', more: 'Thumb', change: -shift },
  { part: 'lean', kind: 'Turn', less: 'Little finger', more: 'Thumb', change: turn },
  { part: 'pitch', kind: 'Turn', less: 'Fingers down', more: 'Fingers up', change: -turn },
  { part: 'roll', kind: 'Turn', less: 'Palm up', more: 'Palm down', change: turn },
];

/** The headings of the two kinds of steps. */
export const gripKinds = { Move: 'Move the drawn hands', Turn: 'Turn the drawn hands' } as const;

/** A row of the controls: a step, and its sum so far. */
export interface GripRow extends GripStep {
  /** The sum in words; that of the left hand and that of the right one, if they differ. */
  readonly value: string;
  /** Whether the largest correction is reached by steps back, and by steps on. */
  readonly atLeast: boolean;
  readonly atMost: boolean;
}

export interface GripState {
  /** The names of the corrected controllers, in words. */
  readonly device: string;
  readonly hands: GripHands;
  readonly rows: readonly GripRow[];
}

const stepsOf = (offset: GripOffset | undefined, { part, change }: GripStep): number =>
  Math.round((offset?.[part] ?? 0) / change);

const mostSteps = ({ part, change }: GripStep): number => Math.round(largestGripOffset[part] / Math.abs(change));

const signed = (value: number): string => `${value > 0 ? '+' : value < 0 ? '−' : ''}${Math.abs(value)}`;

function inWords(steps: readonly number[], { kind }: GripStep): string {
  const [size, unit] = kind === 'Move' ? [millimetres, ' mm'] : [degrees, '°'];
  return `${steps.map((count) => signed(size * count)).join(' / ')}${unit}`;
}

/** The parts of profile names whose spelling differs from a capitalised word. */
const brandWords: Readonly<Record<string, string>> = {
  htc: 'HTC',
  mx: 'MX',
  bytedance: 'ByteDance',
  galaxyxr: 'Galaxy XR',
};

/** Returns the name of a controller in words, from its profile name such as `meta-quest-touch-plus`. */
const controllerName = (profile: string): string =>
  profile
    .split('-')
    .map((word) => brandWords[word] ?? word.charAt(0).toUpperCase() + word.slice(1))
    .join(' ');

/** Corrects how the user holds the controllers: those in their hands, or after a session those held last. */
export class GripControl {
  readonly #parts: Pick<StageParts, 'body' | 'store' | 'headset' | 'onChange'>;
  #hands: GripHands = 'both';

  constructor(parts: Pick<StageParts, 'body' | 'store' | 'headset' | 'onChange'>) {
    this.#parts = parts;
  }

  /** Null: no controller is or was held. */
  get state(): GripState | null {
    const corrected = this.#corrected();
    if (corrected.length === 0) return null;
    const offsets = corrected.map(({ side, device }) => this.#offsets[device]?.[side]);
    const distinct = <Value>(values: readonly Value[]): readonly Value[] => [...new Set(values)];
    return {
      device: distinct(corrected.map(({ device }) => controllerName(device))).join(', '),
      hands: this.#chosen,
      rows: gripSteps.map((step) => {
        const steps = offsets.map((offset) => stepsOf(offset, step));
        return {
          ...step,
          value: inWords(distinct(steps), step),
          atLeast: steps.every((count) => count <= -mostSteps(step)),
          atMost: steps.every((count) => count >= mostSteps(step)),
        };
      }),
    };
  }

  chooseHands(hands: GripHands): void {
    this.#hands = hands;
    this.#parts.onChange();
  }

  /** Moves or turns the chosen hands by one step: on for 1, back for −1. */
  step(step: GripStep, direction: -1 | 1): void {
    const most = mostSteps(step);
    this.#correct((offset) => {
      const steps = Math.min(most, Math.max(-most, stepsOf(offset, step) + direction));
      return { ...offset, [step.part]: steps * step.change };
    });
  }

  /** Removes the corrections of the chosen hands. */
  reset(): void {
    this.#correct(() => undefined);
  }

  get #offsets() {
    return this.#parts.body.userCalibration.gripOffsets ?? {};
  }

  get #devices() {
    const { headset, store } = this.#parts;
    return headset.heldDevices ?? store.preferences.gripDevices ?? {};
  }

  /** The chosen hands; both, while the chosen one holds no controller. */
  get #chosen(): GripHands {
    return this.#hands === 'both' || this.#devices[this.#hands] === undefined ? 'both' : this.#hands;
  }

  #corrected() {
    const [devices, chosen] = [this.#devices, this.#chosen];
    return sides.flatMap((side) => {
      const device = devices[side];
      return device === undefined || (chosen !== 'both' && chosen !== side) ? [] : [{ side, device }];
    });
  }

  #correct(change: (offset: GripOffset | undefined) => GripOffset | undefined): void {
    const { body, store, onChange } = this.#parts;
    const gripOffsets = { ...this.#offsets };
    for (const { side, device } of this.#corrected())
      gripOffsets[device] = { ...gripOffsets[device], [side]: change(gripOffsets[device]?.[side]) };
    body.setGripOffsets(gripOffsets);
    store.remember({ gripOffsets });
    onChange();
  }
}
