import {
  CanvasTexture,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  SRGBColorSpace,
  Vector3,
} from 'three';

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
  const scale = new Vector3();
  return {
    mesh,
    /** Clears the panel and draws. Call it only when something changed. */
    draw(paint: (context: CanvasRenderingContext2D) => void): void {
      context.clearRect(0, 0, width, height);
      paint(context);
      texture.needsUpdate = true;
    },
    /** Returns a point of the world on the canvas [pixels], and its distance in front of the panel [m]. */
    locate(point: Vector3): { readonly x: number; readonly y: number; readonly distance: number } {
      mesh.worldToLocal(local.copy(point));
      const { z } = mesh.getWorldScale(scale);
      return {
        x: width / 2 + local.x * pixelsPerMetre,
        y: height / 2 - local.y * pixelsPerMetre,
        distance: local.z * z,
      };
    },
  };
}

export type VrPanel = ReturnType<typeof createVrPanel>;
