import { expect } from 'vitest';
import type { VrMenuState } from '../../../src/page/shell/panels/vr-menu/menu-buttons';

/** The menu in the studio without a notice; tests change what they are about. */
export const studioMenu: VrMenuState = {
  estimator: 'ik',
  unavailable: {},
  calibration: null,
  overlay: false,
  deviceBody: false,
  nextPassthrough: null,
  beside: null,
  inPassthrough: false,
  builtInBody: 'mannequin',
  skinTone: undefined,
  holdsControllers: false,
  places: [],
  activity: null,
  sheet: null,
  notice: null,
};

interface WrittenText {
  readonly text: string;
  readonly size: number;
  readonly y: number;
  /** The most that the text may take [pixels]; undefined: any width. */
  readonly most: number | undefined;
}

/** Returns a canvas context that records texts and boxes in order. Letters are as wide as half their height. */
export function paper() {
  const texts: WrittenText[] = [];
  const boxes: { readonly fill: string; readonly at: readonly number[] }[] = [];
  const size = () => Number(/(\d+)px/.exec(context.font)?.[1]);
  const nothing = () => undefined;
  const context = {
    ...{ font: '', fillStyle: '', textAlign: '', textBaseline: '', globalAlpha: 1, lineWidth: 1, strokeStyle: '' },
    ...{ beginPath: nothing, roundRect: nothing, arc: nothing, fill: nothing, stroke: nothing },
    measureText: (text: string) => ({ width: text.length * 0.5 * size() }),
    fillText: (text: string, _: number, y: number, most?: number) => void texts.push({ text, size: size(), y, most }),
    fillRect: (...at: readonly number[]) => void boxes.push({ fill: context.fillStyle, at }),
  };
  return { context: context as unknown as CanvasRenderingContext2D, texts, boxes };
}

interface Placed {
  readonly id: string;
  /** Left, top, width, height [pixels]. */
  readonly at: readonly [number, number, number, number];
}

/** Asserts that no two of these cover each other. */
export function expectApart(placed: readonly Placed[]): void {
  const tolerance = 1e-6;
  for (const [index, { id, at }] of placed.entries()) {
    const [x, y, w, h] = at;
    for (const { id: other, at: theirs } of placed.slice(index + 1)) {
      const [left, top, wide, high] = theirs;
      const beside = left >= x + w - tolerance || left + wide <= x + tolerance;
      const below = top >= y + h - tolerance || top + high <= y + tolerance;
      expect(beside || below, `${id} and ${other}`).toBe(true);
    }
  }
}
