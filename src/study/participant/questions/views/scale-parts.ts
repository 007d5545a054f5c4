import { element } from 'threepoint-ui';
import { vrColors, vrFont } from 'threepoint-ui/vr';
import { inner, margin, width } from '../sheet-target';

/** A point that can be chosen. */
export interface ScreenPoint<Value> {
  readonly value: Value;
  /** Its label; empty: the value alone is shown. */
  readonly label: string;
}

/** The texts below the ends of a scale. */
export interface ScreenEnds {
  readonly low: string;
  readonly high: string;
}

/** A scale with more points shows no numbers, on the card as on the sheet, as on the paper form of NASA-TLX. */
export const maxNumberedPoints = 11;

/** Returns the node on the card with the texts below the ends of a scale. */
export const endNodes = ({ low, high }: ScreenEnds): HTMLElement =>
  element('div', { class: 'ends', 'aria-hidden': 'true' }, element('span', {}, low), element('span', {}, high));

/** Draws the texts below the ends of a scale on the sheet, at this height [pixels]. */
export function paintEnds(context: CanvasRenderingContext2D, { low, high }: ScreenEnds, y: number): void {
  context.font = `500 32px ${vrFont}`;
  context.fillStyle = vrColors.inkSoft;
  context.fillText(low, margin, y, inner / 2 - 140);
  context.textAlign = 'right';
  context.fillText(high, width - margin, y, inner / 2 - 140);
  context.textAlign = 'left';
}

/** Points of which one can be chosen. */
export interface Radios<Value> {
  readonly name: string;
  readonly points: readonly ScreenPoint<Value>[];
  readonly answer: Value | null;
  readonly choose: (value: Value) => void;
  /** Returns the content of a point and its accessible name; undefined: the content names it. */
  readonly inside: (
    point: ScreenPoint<Value>,
    index: number,
  ) => { readonly nodes: readonly Node[]; readonly name?: string };
}

/** Returns a labelled radio button for each point. */
export const radios = <Value extends string | number>({ name, points, answer, choose, inside }: Radios<Value>) =>
  points.map((point, index) => {
    const { nodes, name: accessibleName } = inside(point, index);
    const radio = element('input', {
      type: 'radio',
      name,
      value: point.value,
      checked: answer === point.value,
      'data-id': `answer-${point.value}`,
      'aria-label': accessibleName,
    });
    radio.addEventListener('change', () => choose(point.value));
    return element('label', { class: 'choice' }, radio, ...nodes);
  });
