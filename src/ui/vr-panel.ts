import {
  CanvasTexture,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  SRGBColorSpace,
  Vector3,
} from 'three';
import type { Ray, Vec3 } from 'threepoint/math';

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
