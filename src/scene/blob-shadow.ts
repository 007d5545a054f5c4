import { CanvasTexture, Mesh, MeshBasicMaterial, PlaneGeometry } from 'three';

/** A soft dark disc under the body: the cheap shadow that says the feet are on the ground. */
export function createBlobShadow(): Mesh<PlaneGeometry, MeshBasicMaterial> {
  const size = 128;
  const canvas = document.createElement('canvas');
  canvas.width = size;
  canvas.height = size;
  const context = canvas.getContext('2d');
  if (!context) throw new Error('scene/blob-shadow: this browser offers no 2D canvas');
  const gradient = context.createRadialGradient(size / 2, size / 2, 0, size / 2, size / 2, size / 2);
  gradient.addColorStop(0, 'rgba(6, 9, 14, 1)');
  gradient.addColorStop(0.45, 'rgba(6, 9, 14, 0.5)');
  gradient.addColorStop(1, 'rgba(6, 9, 14, 0)');
  context.fillStyle = gradient;
  context.fillRect(0, 0, size, size);
  const blob = new Mesh(
    new PlaneGeometry(1.1, 1.1).rotateX(-Math.PI / 2),
    new MeshBasicMaterial({ map: new CanvasTexture(canvas), transparent: true, depthWrite: false, toneMapped: false }),
  );
  blob.position.y = 0.006;
  blob.renderOrder = 1;
  return blob;
}
