import { type CanvasTexture, Group, type Matrix4, Sprite, SpriteMaterial, Vector3 } from 'three';
import { clamp, type Vec3 } from 'threepoint/math';
import { drawText, textWidth } from 'threepoint-ui/vr';
import { ink } from '../../scene/boards/board-style';
import { createCanvasTexture } from '../../scene/canvas-texture';
import type { Quality } from '../../scene/renderer';
import type { DisplayedPlayer } from './displayed-match';
import { displayName } from './displayed-match';
import { paintSeatMark } from './seat-looks';

export interface Label {
  readonly person: DisplayedPlayer;
  /** The position of the eyes. */
  readonly head: Vec3;
  readonly opacity: number;
  /** Whether the player takes part in the voices, and is audible. */
  readonly voice: 'none' | 'muted' | 'open';
  /** How loud they speak: 0 to 1. */
  readonly level: number;
}

const size = { width: 640, height: 160 } as const;
/** Width in the world [m]. */
const metres = 0.86;
/** Its lower edge above the eyes [m]. */
const above = 0.25;
/** Seen from further away than this it grows with the distance, so that a name stays as large to the eye [m]. */
const readableFrom = 2.8;
/** A larger label would hide its neighbour. */
const maxScale = 3;

/** How many times its own size a label is drawn for a camera this far away [m]. */
export const labelScale = (far: number): number => clamp(far / readableFrom, 1, maxScale);

/** A microphone in a box of this height, its middle here [pixels]; struck through where its player is muted. */
function paintMicrophone(context: CanvasRenderingContext2D, x: number, y: number, muted: boolean): void {
  const color = muted ? ink.warning : '#7be0a5';
  context.strokeStyle = color;
  context.fillStyle = color;
  context.lineWidth = 6;
  context.lineCap = 'round';
  context.beginPath();
  context.roundRect(x - 10, y - 32, 20, 38, 10);
  context.fill();
  context.beginPath();
  context.arc(x, y - 6, 20, 0, Math.PI);
  context.moveTo(x, y + 14);
  context.lineTo(x, y + 28);
  context.moveTo(x - 12, y + 29);
  context.lineTo(x + 12, y + 29);
  context.stroke();
  if (!muted) return;
  for (const [stroke, line] of [
    ['rgb(16, 24, 33)', 16],
    [color, 6],
  ] as const) {
    context.strokeStyle = stroke;
    context.lineWidth = line;
    context.beginPath();
    context.moveTo(x - 26, y - 30);
    context.lineTo(x + 26, y + 26);
    context.stroke();
  }
}

/** Paints the ring around the mark of a speaking player; all labels share it. */
function paintRing(context: CanvasRenderingContext2D): void {
  context.strokeStyle = '#7be0a5';
  context.lineWidth = 12;
  context.beginPath();
  context.arc(64, 64, 54, 0, 2 * Math.PI);
  context.stroke();
}

/** The size of the ring's texture [pixels]. The ring is slightly larger than the mark. */
const ringSize = 128;
const ringScale = 0.86;

/** How wide a label is, and so where its mark is [pixels]. */
function labelWidth(context: CanvasRenderingContext2D, { person, voice }: Pick<Label, 'person' | 'voice'>): number {
  const named = Math.max(textWidth(context, displayName(person), '700 54px'), 190) + 132;
  return Math.min(size.width - 24, named + (voice === 'none' ? 0 : voiceWidth));
}

/** What the microphone takes of a label's width [pixels]. */
const voiceWidth = 60;

/** Draws a label; the middle of its mark, from the left [pixels]. */
function paint(context: CanvasRenderingContext2D, { person, voice }: Label, roles: readonly string[]): number {
  const { width, height } = size;
  const name = displayName(person);
  const under = person.presence === 'here' ? (roles[person.station] ?? '') : 'Away';
  const wide = labelWidth(context, { person, voice });
  const text = wide - 134 - (voice === 'none' ? 0 : voiceWidth);
  const left = (width - wide) / 2;
  context.fillStyle = 'rgba(16, 24, 33, 0.86)';
  context.beginPath();
  context.roundRect(left, 8, wide, height - 16, 40);
  context.fill();
  paintSeatMark(context, person.station, [left + 60, height / 2], 36);
  const baseline = 'middle';
  drawText(context, name, [left + 110, height / 2 - 24], {
    font: '700 54px',
    color: ink.text,
    baseline,
    maxWidth: text,
  });
  const color = person.presence === 'here' ? ink.soft : ink.warning;
  drawText(context, under, [left + 110, height / 2 + 34], { font: '600 36px', color, baseline, maxWidth: text });
  if (voice !== 'none') paintMicrophone(context, left + wide - 52, height / 2, voice === 'muted');
  return left + 60;
}

/** Creates a label. The ring around the mark shows speech: the louder, the clearer. */
function createLabel(roles: readonly string[], quality: Quality, ringTexture: CanvasTexture) {
  const { texture, draw } = createCanvasTexture(size.width, size.height, quality);
  const material = new SpriteMaterial({
    map: texture,
    transparent: true,
    fog: false,
    toneMapped: false,
    depthWrite: false,
  });
  const sprite = new Sprite(material);
  const ring = new Sprite(
    new SpriteMaterial({ map: ringTexture, transparent: true, fog: false, toneMapped: false, depthWrite: false }),
  );
  const wide = (metres * ringSize * ringScale) / size.width;
  const height = (metres * size.height) / size.width;
  const head = new Vector3();
  const there = new Vector3();
  const eye = new Vector3();
  /** Places the label for one camera: a window's camera is not at the player's eyes. */
  const place = (one: Sprite, matrixWorld: Matrix4, across: number, down: number) => {
    sprite.parent?.localToWorld(there.copy(head));
    const grown = labelScale(there.distanceTo(eye.setFromMatrixPosition(matrixWorld)));
    one.scale.set(grown * across, grown * down, 1);
    one.position.set(head.x, head.y + above + (grown * height) / 2, head.z);
    one.updateMatrixWorld();
  };
  sprite.onBeforeRender = (_renderer, _scene, { matrixWorld }) => place(sprite, matrixWorld, metres, height);
  ring.onBeforeRender = (_renderer, _scene, { matrixWorld }) => place(ring, matrixWorld, wide, wide);
  // The position is set when the sprite is drawn, so frustum culling has no valid position.
  for (const one of [sprite, ring]) {
    one.frustumCulled = false;
    one.visible = false;
  }
  sprite.renderOrder = 4;
  ring.renderOrder = 5;
  let shown = '';
  return {
    sprites: [sprite, ring],
    show(label: Label | null): void {
      sprite.visible = label !== null && label.opacity > 0;
      ring.visible = sprite.visible && label !== null && label.level > 0;
      if (!label) return;
      const key = JSON.stringify([label.person, label.voice]);
      if (key !== shown) {
        shown = key;
        draw((context) => {
          const mark = paint(context, label, roles);
          // A sprite turns around its centre, which for this one is the mark, not its own middle.
          ring.center.x = 0.5 - ((mark / size.width - 0.5) * metres) / wide;
        });
      }
      head.copy(label.head);
      material.opacity = label.opacity;
      ring.material.opacity = label.opacity * label.level;
    },
  };
}

/** Names and roles over heads, for a player of each role; arena frame. */
export function createNameLabels(roles: readonly string[], quality: Quality) {
  const object = new Group();
  object.name = 'names';
  const ring = createCanvasTexture(ringSize, ringSize, quality);
  ring.draw(paintRing);
  const labels = roles.map(() => createLabel(roles, quality, ring.texture));
  object.add(...labels.flatMap(({ sprites }) => sprites));
  return {
    object,
    /** Shows the labels, by player; null: there is no player, or it is the user. */
    show(next: readonly (Label | null)[]): void {
      labels.forEach((label, index) => {
        label.show(next[index] ?? null);
      });
    },
  };
}

export type NameLabels = ReturnType<typeof createNameLabels>;
