import {
  CanvasTexture,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  SRGBColorSpace,
  Vector3,
} from 'three';
import type { Ray } from 'threepoint/core/math/ray';
import type { Vec3 } from 'threepoint/core/math/vec3';

/** A place on a panel's canvas [pixels]. */
export interface PanelPoint {
  x: number;
  y: number;
  /** The distance in front of the panel, or along a ray [m]. */
  distance: number;
}

/**
 * A flat panel in the world that is drawn on a 2D canvas; visible from its front (+Z) only, so that a mirror shows no
 * back. Width and height in canvas pixels; pixelsPerMetre sets the size in the world.
 */
export function createVrPanel(width: number, height: number, pixelsPerMetre: number) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d');
  if (!context) throw new Error('ui/vr-panel: this browser does not support 2D canvas');
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.anisotropy = 4;
  const mesh = new Mesh(
    new PlaneGeometry(width / pixelsPerMetre, height / pixelsPerMetre),
    new MeshBasicMaterial({ map: texture, transparent: true, toneMapped: false, fog: false }),
  );
  const local = new Vector3();
  const step = new Vector3();
  /** Writes where the local point lies on the canvas. */
  function place(out: PanelPoint, distance: number): PanelPoint {
    out.x = width / 2 + local.x * pixelsPerMetre;
    out.y = height / 2 - local.y * pixelsPerMetre;
    out.distance = distance;
    return out;
  }
  return {
    mesh,
    /** Clears the panel and draws. Call it only when something changed. */
    draw(paint: (context: CanvasRenderingContext2D) => void): void {
      context.clearRect(0, 0, width, height);
      paint(context);
      texture.needsUpdate = true;
    },
    /** Writes where a point of the world lies on the canvas, and its distance in front of the panel. */
    locate(point: Vec3, out: PanelPoint): PanelPoint {
      mesh.worldToLocal(local.copy(point));
      return place(out, local.z * mesh.getWorldScale(step).z);
    },
    /** Writes where a ray of the world meets the panel's front; returns null where it does not, and writes nothing. */
    meet({ origin, direction }: Ray, out: PanelPoint): PanelPoint | null {
      mesh.worldToLocal(local.copy(origin));
      mesh.worldToLocal(step.copy(origin).add(direction)).sub(local);
      if (local.z < 0 || step.z >= 0) return null;
      const distance = -local.z / step.z;
      local.addScaledVector(step, distance);
      const isBeside = Math.max(Math.abs(local.x) / width, Math.abs(local.y) / height) * pixelsPerMetre > 0.5;
      return isBeside ? null : place(out, distance);
    },
  };
}

export type VrPanel = ReturnType<typeof createVrPanel>;

/** The colours of the page (styles/page/base.css), for canvases. */
export const vrColors = {
  ink: '#f1f4f9',
  inkSoft: '#b6c1d3',
  glass: 'rgba(18, 24, 35, 0.92)',
  line: 'rgba(190, 208, 238, 0.22)',
  lift: 'rgba(190, 208, 238, 0.12)',
  liftMore: 'rgba(190, 208, 238, 0.28)',
  accent: '#ffb468',
  accentInk: '#2a1703',
} as const;

export const vrFont = 'Inter, "Segoe UI", system-ui, Roboto, sans-serif';

/** How a text is written on a canvas. */
export interface TextStyle {
  /** Weight and size. */
  readonly font: string;
  readonly color: string;
  /** Default: left. */
  readonly align?: CanvasTextAlign;
  /** Default: alphabetic. */
  readonly baseline?: CanvasTextBaseline;
  /** The greatest width [pixels]; a longer text is compressed. */
  readonly maxWidth?: number;
}

/** Writes a text at a place of a canvas [pixels]. */
export function drawText(
  context: CanvasRenderingContext2D,
  text: string,
  [x, y]: readonly [number, number],
  { font, color, align = 'left', baseline = 'alphabetic', maxWidth }: TextStyle,
): void {
  context.font = `${font} ${vrFont}`;
  context.fillStyle = color;
  context.textAlign = align;
  context.textBaseline = baseline;
  context.fillText(text, x, y, maxWidth);
}

/**
 * Writes a text in lines of at most `width` pixels, broken at spaces, the first at (x, y) and each `step` below the one
 * before. `mostLines`: further ones are left out.
 */
export function drawTextLines(
  context: CanvasRenderingContext2D,
  text: string,
  [x, y, width]: readonly [number, number, number],
  step: number,
  writing: TextStyle,
  mostLines?: number,
): void {
  context.font = `${writing.font} ${vrFont}`;
  const lines = wrapText(context, text, width).slice(0, mostLines);
  for (const [index, line] of lines.entries()) drawText(context, line, [x, y + index * step], writing);
}

/** Returns the width of a text in a weight and size [pixels]. */
export function textWidth(context: CanvasRenderingContext2D, text: string, font: string): number {
  context.font = `${font} ${vrFont}`;
  return context.measureText(text).width;
}

export function fillRoundedRect(
  context: CanvasRenderingContext2D,
  [x, y, width, height]: readonly [number, number, number, number],
  radius: number,
  fill: string,
  stroke?: string,
): void {
  context.beginPath();
  context.roundRect(x, y, width, height, radius);
  context.fillStyle = fill;
  context.fill();
  if (stroke) {
    context.lineWidth = 2;
    context.strokeStyle = stroke;
    context.stroke();
  }
}

/** Lines of at most `most` pixels, broken at spaces. */
export function wrapText(context: CanvasRenderingContext2D, text: string, most: number): string[] {
  const lines: string[] = [];
  let line = '';
  for (const word of text.split(' ')) {
    const longer = line ? `${line} ${word}` : word;
    if (line && context.measureText(longer).width > most) {
      lines.push(line);
      line = word;
    } else line = longer;
  }
  return [...lines, line];
}
