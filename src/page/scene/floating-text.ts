import { Sprite, SpriteMaterial } from 'three';
import { distance, type Vec3 } from 'threepoint/math';
import { vrFont } from 'threepoint-ui/vr';
import { ink } from './boards/board-style';
import { createCanvasTexture } from './canvas-texture';
import type { Quality } from './renderer';

/** Height of the letters, as a share of the distance from which they are read. */
const apparentSize = 0.055;

interface FloatingTextOptions {
  readonly quality: Quality;
  /** How long it is seen [s]. */
  readonly seconds: number;
  /** The initial height above its place [heights of its letters]. */
  readonly lift: number;
}

/** A word that rises from a place for a moment and fades, over everything, as large for every reader. */
export class FloatingText {
  readonly object: Sprite;
  readonly #options: FloatingTextOptions;
  readonly #drawn: ReturnType<typeof createCanvasTexture>;
  #text = '';

  constructor(options: FloatingTextOptions) {
    this.#options = options;
    this.#drawn = createCanvasTexture(256, 128, options.quality);
    const map = this.#drawn.texture;
    this.object = new Sprite(
      new SpriteMaterial({ map, transparent: true, depthTest: false, fog: false, toneMapped: false }),
    );
    this.object.renderOrder = 6;
    this.object.visible = false;
  }

  /** Writes a text. Draws only if the text has changed. */
  write(text: string, colour: string): void {
    if (text === this.#text) return;
    this.#text = text;
    this.#drawn.draw((context) => {
      context.textAlign = 'center';
      context.textBaseline = 'middle';
      context.font = `800 100px ${vrFont}`;
      context.lineWidth = 18;
      context.lineJoin = 'round';
      context.strokeStyle = ink.accentInk;
      context.strokeText(text, 128, 68);
      context.fillStyle = colour;
      context.fillText(text, 128, 68);
    });
  }

  /**
   * Shows the word at this place, arena frame, at this age [s]; before and after its time it is hidden. `eyes`: the
   * reader's.
   */
  show(place: Vec3, age: number, eyes: Vec3): void {
    const share = age / this.#options.seconds;
    this.object.visible = share >= 0 && share < 1;
    if (!this.object.visible) return;
    const size = apparentSize * distance(place, eyes);
    this.object.position.set(place.x, place.y + size * (this.#options.lift + 1.8 * (1 - (1 - share) ** 2)), place.z);
    this.object.scale.set(2 * size, size, 1);
    this.object.material.opacity = Math.min(1, 3 * (1 - share));
  }

  hide(): void {
    this.object.visible = false;
  }
}
