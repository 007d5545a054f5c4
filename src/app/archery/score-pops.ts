import { Group, Sprite, SpriteMaterial } from 'three';
import type { ArcheryState, Landing } from '../../core/games/archery/archery-state';
import { distance, type Vec3 } from '../../core/math/vec3';
import { ink, signFont } from '../../scene/boards/lettering';
import { createDrawnTexture } from '../../scene/drawn-texture';
import type { Quality } from '../../scene/renderer';

/** Points that rise from a target for a moment when it is hit; arena frame. */
export interface ScorePops {
  readonly object: Group;
  /** At a time of the match [s], seen by eyes at `head`. */
  show(state: ArcheryState, time: number, head: Vec3): void;
  dispose(): void;
}

const seconds = 1.5;
/** Height of the letters, as a share of the distance from which they are read. */
const apparentSize = 0.055;
const atOnce = 2;

function createPop(quality: Quality) {
  const { texture, draw } = createDrawnTexture(256, 128, quality);
  const material = new SpriteMaterial({
    map: texture,
    transparent: true,
    depthTest: false,
    fog: false,
    toneMapped: false,
  });
  const sprite = new Sprite(material);
  sprite.renderOrder = 6;
  sprite.visible = false;
  let shown = '';
  return {
    sprite,
    texture,
    show({ position, points, time: landed }: Landing, time: number, head: Vec3) {
      const text = points > 0 ? `+${points}` : 'again';
      if (text !== shown) {
        shown = text;
        draw((context) => {
          context.textAlign = 'center';
          context.textBaseline = 'middle';
          context.font = `800 100px ${signFont}`;
          context.lineWidth = 18;
          context.lineJoin = 'round';
          context.strokeStyle = ink.accentInk;
          context.strokeText(text, 128, 68);
          context.fillStyle = points > 0 ? ink.accent : ink.text;
          context.fillText(text, 128, 68);
        });
      }
      const age = (time - landed) / seconds;
      const size = apparentSize * distance(position, head);
      sprite.visible = true;
      sprite.position.set(position.x, position.y + size * (1.4 + 1.8 * (1 - (1 - age) ** 2)), position.z);
      sprite.scale.set(2 * size, size, 1);
      material.opacity = Math.min(1, 3 * (1 - age));
    },
  };
}

export function createScorePops(quality: Quality): ScorePops {
  const object = new Group();
  object.name = 'score pops';
  const pops = Array.from({ length: atOnce }, () => createPop(quality));
  object.add(...pops.map(({ sprite }) => sprite));
  return {
    object,
    show(state, time, head) {
      const fresh = state.arrows
        .flatMap(({ landing }) => (landing && landing.target !== null ? [landing] : []))
        .filter((landing) => time >= landing.time && time < landing.time + seconds)
        .slice(-atOnce);
      pops.forEach((pop, index) => {
        const landing = fresh[index];
        pop.sprite.visible = false;
        if (landing) pop.show(landing, time, head);
      });
    },
    dispose() {
      object.removeFromParent();
      for (const { sprite, texture } of pops) {
        sprite.material.dispose();
        texture.dispose();
      }
    },
  };
}
