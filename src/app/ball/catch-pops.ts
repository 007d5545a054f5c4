import { Group, Sprite, SpriteMaterial } from 'three';
import { distance, type Vec3 } from '../../core/math/vec3';
import { ink, signFont } from '../../scene/boards/lettering';
import { createDrawnTexture } from '../../scene/drawn-texture';
import type { Quality } from '../../scene/renderer';

/** "+1" that rises from the basket for a moment at each catch; arena frame. */
export interface CatchPops {
  readonly object: Group;
  /** A catch at a place, at a time of the match [s]. */
  add(at: Vec3, time: number): void;
  show(time: number, eyes: Vec3): void;
  dispose(): void;
}

const seconds = 1.3;
/** Height of the letters, as a share of the distance from which they are read. */
const apparentSize = 0.055;

export function createCatchPops(quality: Quality): CatchPops {
  const object = new Group();
  object.name = 'catches';
  const { texture, draw } = createDrawnTexture(256, 128, quality);
  draw((context) => {
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.font = `800 100px ${signFont}`;
    context.lineWidth = 18;
    context.lineJoin = 'round';
    context.strokeStyle = ink.accentInk;
    context.strokeText('+1', 128, 68);
    context.fillStyle = ink.accent;
    context.fillText('+1', 128, 68);
  });
  const pops = [0, 1].map(() => {
    const sprite = new Sprite(
      new SpriteMaterial({ map: texture, transparent: true, depthTest: false, fog: false, toneMapped: false }),
    );
    sprite.renderOrder = 6;
    sprite.visible = false;
    object.add(sprite);
    return { sprite, at: null as Vec3 | null, from: 0 };
  });
  let next = 0;
  return {
    object,
    add(at, time) {
      const pop = pops[next % pops.length];
      next += 1;
      if (pop) Object.assign(pop, { at, from: time });
    },
    show(time, eyes) {
      for (const { sprite, at, from } of pops) {
        const age = (time - from) / seconds;
        sprite.visible = at !== null && age >= 0 && age < 1;
        if (!at || !sprite.visible) continue;
        const size = apparentSize * distance(at, eyes);
        sprite.position.set(at.x, at.y + size * (1.2 + 1.8 * (1 - (1 - age) ** 2)), at.z);
        sprite.scale.set(2 * size, size, 1);
        sprite.material.opacity = Math.min(1, 3 * (1 - age));
      }
    },
    dispose() {
      object.removeFromParent();
      texture.dispose();
      for (const { sprite } of pops) sprite.material.dispose();
    },
  };
}
