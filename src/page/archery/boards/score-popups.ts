import { Group } from 'three';
import type { Vec3 } from 'threepoint/math';
import type { ArcheryState } from 'threepoint-games/archery';
import { ink } from '../../scene/boards/board-style';
import { FloatingText } from '../../scene/floating-text';
import type { Quality } from '../../scene/renderer';

const seconds = 1.5;
const atOnce = 2;

/** Points that rise from a target for a moment when it is hit; arena frame. */
export class ScorePopups {
  readonly object = new Group();
  readonly #words: readonly FloatingText[];

  constructor(quality: Quality) {
    this.object.name = 'score pops';
    this.#words = Array.from({ length: atOnce }, () => new FloatingText({ quality, seconds, lift: 1.4 }));
    this.object.add(...this.#words.map(({ object }) => object));
  }

  /** Shows the newest hits at a match time [s] to eyes at `head`. */
  show({ arrows }: ArcheryState, time: number, head: Vec3): void {
    let next = 0;
    for (let i = arrows.length - 1; i >= 0 && next < this.#words.length; i--) {
      const landing = arrows[i]?.landing;
      if (!landing || landing.target === null || time < landing.time || time >= landing.time + seconds) continue;
      const word = this.#words[next]!;
      next += 1;
      word.write(landing.points > 0 ? `+${landing.points}` : 'again', landing.points > 0 ? ink.accent : ink.text);
      word.show(landing.position, time - landing.time, head);
    }
    for (; next < this.#words.length; next++) this.#words[next]?.hide();
  }
}
