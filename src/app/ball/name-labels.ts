import { Group, Sprite, SpriteMaterial, Vector3 } from 'three';
import { clamp } from '../../core/math/damper';
import type { Vec3 } from '../../core/math/vec3';
import { ink, signFont } from '../../scene/boards/lettering';
import { createDrawnTexture } from '../../scene/drawn-texture';
import type { Quality } from '../../scene/renderer';
import { nameOf, type Person } from './board-drawing';
import { roleTexts, seatLooks } from './court-plan';

/** Names and roles over heads; arena frame. */
export interface NameLabels {
  readonly object: Group;
  /** By player; null: no player is there, or it is one's own. */
  show(labels: readonly (Label | null)[]): void;
  dispose(): void;
}

export interface Label {
  readonly person: Person;
  readonly station: number;
  /** Of the eyes. */
  readonly head: Vec3;
  readonly opacity: number;
}

const size = { width: 640, height: 160 } as const;
/** Width in the world [m]. */
const metres = 0.86;
/** Its lower edge above the eyes [m]. */
const above = 0.25;
/** Seen from further away than this it grows with the distance, so that a name stays as large to the eye [m]. */
const readableFrom = 2.8;
/** Larger than this it would hide a neighbour's. */
const mostGrown = 3;

/** How many times its own size a label is drawn for a camera this far away [m]. */
export const labelScale = (far: number): number => clamp(far / readableFrom, 1, mostGrown);

function paint(context: CanvasRenderingContext2D, person: Person, station: number): void {
  const { width, height } = size;
  const look = seatLooks[station];
  const name = nameOf(person);
  const under = person.presence === 'here' ? (roleTexts[station] ?? '') : 'Away';
  context.font = `700 54px ${signFont}`;
  const wide = Math.min(width - 24, Math.max(context.measureText(name).width, 190) + 132);
  const left = (width - wide) / 2;
  context.fillStyle = 'rgba(16, 24, 33, 0.86)';
  context.beginPath();
  context.roundRect(left, 8, wide, height - 16, 40);
  context.fill();
  context.fillStyle = look?.color ?? ink.soft;
  context.beginPath();
  context.arc(left + 60, height / 2, 36, 0, 2 * Math.PI);
  context.fill();
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillStyle = look?.ink ?? ink.text;
  context.font = `800 42px ${signFont}`;
  context.fillText(look?.mark ?? '', left + 60, height / 2 + 3);
  context.textAlign = 'left';
  context.fillStyle = ink.text;
  context.font = `700 54px ${signFont}`;
  context.fillText(name, left + 110, height / 2 - 24, wide - 134);
  context.fillStyle = person.presence === 'here' ? ink.soft : ink.warning;
  context.font = `600 36px ${signFont}`;
  context.fillText(under, left + 110, height / 2 + 34, wide - 134);
}

function createLabel(quality: Quality) {
  const { texture, draw } = createDrawnTexture(size.width, size.height, quality);
  const material = new SpriteMaterial({
    map: texture,
    transparent: true,
    fog: false,
    toneMapped: false,
    depthWrite: false,
  });
  const sprite = new Sprite(material);
  const height = (metres * size.height) / size.width;
  const head = new Vector3();
  const there = new Vector3();
  const eye = new Vector3();
  /** For each camera anew: a window's is not where the player's eyes are. */
  sprite.onBeforeRender = (_renderer, _scene, { matrixWorld }) => {
    sprite.parent?.localToWorld(there.copy(head));
    const grown = labelScale(there.distanceTo(eye.setFromMatrixPosition(matrixWorld)));
    sprite.scale.set(grown * metres, grown * height, 1);
    sprite.position.set(head.x, head.y + above + (grown * height) / 2, head.z);
    sprite.updateMatrixWorld();
  };
  // It is where it is drawn only once it is drawn.
  sprite.frustumCulled = false;
  sprite.renderOrder = 4;
  sprite.visible = false;
  let shown = '';
  return {
    sprite,
    show(label: Label | null): void {
      sprite.visible = label !== null && label.opacity > 0;
      if (!label) return;
      const key = JSON.stringify([label.person, label.station]);
      if (key !== shown) {
        shown = key;
        draw((context) => paint(context, label.person, label.station));
      }
      head.copy(label.head);
      material.opacity = label.opacity;
    },
    dispose() {
      material.dispose();
      texture.dispose();
    },
  };
}

export function createNameLabels(count: number, quality: Quality): NameLabels {
  const object = new Group();
  object.name = 'names';
  const labels = Array.from({ length: count }, () => createLabel(quality));
  object.add(...labels.map(({ sprite }) => sprite));
  return {
    object,
    show(next) {
      labels.forEach((label, index) => {
        label.show(next[index] ?? null);
      });
    },
    dispose() {
      object.removeFromParent();
      for (const label of labels) label.dispose();
    },
  };
}
