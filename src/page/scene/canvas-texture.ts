import { CanvasTexture, LinearMipmapLinearFilter, SRGBColorSpace } from 'three';
import { anisotropyOf, type Quality } from './renderer';

/** A texture that is drawn on a 2D canvas. Width and height in pixels. Throws where the browser offers no 2D canvas. */
export function createCanvasTexture(width: number, height: number, quality: Quality) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d');
  if (!context) throw new Error('scene/canvas-texture: this browser does not support 2D canvas');
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = LinearMipmapLinearFilter;
  // Anisotropic filtering keeps text legible at a glancing angle.
  texture.anisotropy = Math.max(4, anisotropyOf(quality));
  return {
    texture,
    /** Clears the canvas and draws. Call it only when something changed. */
    draw(paint: (context: CanvasRenderingContext2D) => void): void {
      context.clearRect(0, 0, width, height);
      paint(context);
      texture.needsUpdate = true;
    },
  };
}

export type DrawableTexture = ReturnType<typeof createCanvasTexture>;
