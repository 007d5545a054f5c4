import { Group } from 'three';
import { copyVec3, type MutableVec3, type Vec3, vec3 } from 'threepoint/math';
import { ink } from '../../scene/boards/board-style';
import { FloatingText } from '../../scene/floating-text';
import type { Quality } from '../../scene/renderer';

const seconds = 1.3;
const atOnce = 2;

/** "+1" that rises from the basket for a moment at each catch; arena frame. */
export class CatchPopups {
  readonly object = new Group();
  readonly #catches: readonly { readonly word: FloatingText; readonly at: MutableVec3; from: number }[];
  #next = 0;

  constructor(quality: Quality) {
    this.object.name = 'catches';
    this.#catches = Array.from({ length: atOnce }, () => ({
      word: new FloatingText({ quality, seconds, lift: 1.2 }),
      at: vec3(0, 0, 0),
      from: Number.NEGATIVE_INFINITY,
    }));
    for (const { word } of this.#catches) {
      word.write('+1', ink.accent);
      this.object.add(word.object);
    }
  }

  /**
   * Shows a catch at a position, at a time on the page's clock [s]: the clock of a match restarts with the next one.
   */
  add(at: Vec3, time: number): void {
    const caught = this.#catches[this.#next % this.#catches.length]!;
    this.#next += 1;
    copyVec3(at, caught.at);
    caught.from = time;
  }

  /** Updates the texts to a time on the page's clock [s]. */
  show(time: number, eyes: Vec3): void {
    for (const { word, at, from } of this.#catches) word.show(at, time - from, eyes);
  }
}
