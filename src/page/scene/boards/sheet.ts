import { Matrix4, Mesh, MeshBasicMaterial, PlaneGeometry, Vector3 } from 'three';
import type { Vec3 } from 'threepoint/math';
import { drawText } from 'threepoint-ui/vr';
import { createCanvasTexture } from '../canvas-texture';
import type { Quality } from '../renderer';
import { ink } from './board-style';

/** A button on a sheet [pixels]. */
export interface SheetButton<Id extends string> {
  readonly id: Id;
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

export interface SheetSize {
  /** Pixels. */
  readonly width: number;
  readonly height: number;
  /** Width in the world [m]. */
  readonly metres: number;
}

/** What a sheet shows. Equal keys are painted once. */
export interface SheetContent<Id extends string> {
  readonly key: string;
  readonly buttons: readonly SheetButton<Id>[];
  paint(context: CanvasRenderingContext2D, hovered: Id | null): void;
}

/** The button under a point of the sheet [m, from its middle]. */
export function buttonUnder<Id extends string>(
  buttons: readonly SheetButton<Id>[],
  size: SheetSize,
  x: number,
  y: number,
): Id | null {
  const pixelsPerMetre = size.width / size.metres;
  const px = size.width / 2 + x * pixelsPerMetre;
  const py = size.height / 2 - y * pixelsPerMetre;
  const found = buttons.find(
    (button) => px >= button.x && px <= button.x + button.width && py >= button.y && py <= button.y + button.height,
  );
  return found?.id ?? null;
}

/** A new sheet ignores presses for this time [s], because they were meant for what it covers. */
export const settlingSeconds = 0.5;

/** Decides whether something has been shown for long enough to be pressed. Times [s] on any monotonic clock. */
export function createSettling() {
  let cameAt: number | null = null;
  let now = 0;
  return {
    /** Once a frame. */
    show(shown: boolean, time: number): void {
      now = time;
      cameAt = shown ? (cameAt ?? time) : null;
    },
    get settled(): boolean {
      return cameAt !== null && now - cameAt >= settlingSeconds;
    },
  };
}

/** A sheet in the world with buttons, facing +Z of its own frame. */
export function createSheet<Id extends string>(size: SheetSize, quality: Quality) {
  const { texture, draw } = createCanvasTexture(size.width, size.height, quality);
  const mesh = new Mesh(
    new PlaneGeometry(size.metres, (size.metres * size.height) / size.width),
    new MeshBasicMaterial({ map: texture, transparent: true, fog: false, toneMapped: false }),
  );
  mesh.renderOrder = 5;
  mesh.visible = false;
  let shown: SheetContent<Id> | null = null;
  let hovered: Id | null = null;
  /** What was painted last; null: nothing yet. */
  let drawnKey: string | null = null;
  let drawnHovered: Id | null = null;
  const settling = createSettling();

  function redraw(): void {
    if (!shown) return;
    const content = shown;
    if (content.key === drawnKey && hovered === drawnHovered) return;
    drawnKey = content.key;
    drawnHovered = hovered;
    draw((context) => content.paint(context, hovered));
  }

  const inverse = new Matrix4();
  const from = new Vector3();
  const along = new Vector3();
  return {
    mesh,
    /** Once per frame; null hides it. `time` [s]: on any monotonic clock. */
    show(content: SheetContent<Id> | null, time: number): void {
      settling.show(content !== null, time);
      shown = content;
      mesh.visible = content !== null;
      redraw();
    },
    /**
     * The button that a ray meets, and how far away [m, floor frame; unit direction]; null: none, or no sheet has been
     * there for `settlingSeconds`.
     */
    buttonAt(origin: Vec3, direction: Vec3): { readonly id: Id; readonly distance: number } | null {
      if (!shown || !settling.settled) return null;
      mesh.updateWorldMatrix(true, false);
      inverse.copy(mesh.matrixWorld).invert();
      from.copy(origin).applyMatrix4(inverse);
      along.copy(direction).transformDirection(inverse);
      if (from.z <= 0 || along.z >= 0) return null;
      const distance = -from.z / along.z;
      const id = buttonUnder(shown.buttons, size, from.x + along.x * distance, from.y + along.y * distance);
      return id === null ? null : { id, distance };
    },
    setHovered(id: Id | null): void {
      hovered = id;
      redraw();
    },
  };
}

/** The look of a button; `primary`: the main action of the sheet. */
interface ButtonLook {
  readonly primary?: boolean;
  readonly hovered: boolean;
  /** Weight and size of its label. */
  readonly font: string;
}

/** Paints a rounded button with its label, lit while something points at it. */
export function paintButton(
  context: CanvasRenderingContext2D,
  { x, y, width, height }: SheetButton<string>,
  label: string,
  { primary = false, hovered, font }: ButtonLook,
): void {
  const [fill, lit] = primary ? [ink.accent, ink.accentLift] : ['#34495a', '#4a6275'];
  context.fillStyle = hovered ? lit : fill;
  context.beginPath();
  context.roundRect(x, y, width, height, height / 2);
  context.fill();
  if (hovered) {
    context.strokeStyle = ink.text;
    context.lineWidth = 7;
    context.stroke();
  }
  const color = primary ? ink.accentInk : ink.text;
  const middle = [x + width / 2, y + height / 2 + 4] as const;
  drawText(context, label, middle, { font, color, align: 'center', baseline: 'middle', maxWidth: width - 40 });
}
