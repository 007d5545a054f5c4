import { showToEyesOnly } from 'threepoint/internal/three';
import { addScaled, dampVec3, forward, type Pose, rotate, type Vec3, vec3 } from 'threepoint/math';
import { drawText, fillRoundedRect, textWidth, vrColors } from './canvas-drawing';
import { createVrPanel } from './vr-panel';

const [width, height] = [1000, 96];
/** How far away [m], and how far below the gaze [m] there: 13 degrees. */
const away = 1.5;
const below = 0.35;
const readFor = 2.5;
/** Half-life of the motion towards the gaze [s], so that a glance at the caption does not move it away. */
const halfLife = 0.12;

/** Shows captions of sounds in the headset: a line low in the view, for players without sound. */
export function createVrCaptions() {
  const { mesh, draw } = createVrPanel(width, height, 1100);
  mesh.name = 'captions';
  mesh.renderOrder = 20;
  mesh.visible = false;
  showToEyesOnly(mesh);
  const material = [mesh.material].flat()[0];
  if (material) material.depthTest = false;
  let current: { readonly text: string; until: number | null } | null = null;
  let place: Vec3 | null = null;
  let last = 0;

  return {
    object: mesh,
    /** Shows a caption; an empty text hides it. */
    setText(text: string): void {
      current = text === '' ? null : { text, until: null };
      if (current === null) return;
      draw((context) => {
        const wide = Math.min(width, textWidth(context, text, '600 46px') + 64);
        fillRoundedRect(context, [(width - wide) / 2, 4, wide, height - 8], 28, vrColors.glass);
        const writing = { font: '600 46px', color: vrColors.ink, align: 'center', baseline: 'middle' } as const;
        drawText(context, text, [width / 2, height / 2 + 2], { ...writing, maxWidth: width - 48 });
      });
    },
    /** Shows the caption at this time [s] before these eyes, floor frame; null: no user wears the headset. */
    show(time: number, eyes: Pose<'floor'> | null): void {
      if (current) current.until ??= time + readFor;
      if (!current?.until || time > current.until || !eyes) {
        mesh.visible = false;
        place = null;
        return;
      }
      const ahead = rotate(eyes.orientation, forward);
      const goal = addScaled(addScaled(eyes.position, ahead, away), vec3(0, -1, 0), below);
      place = place === null ? goal : dampVec3(place, goal, halfLife, Math.max(0, time - last));
      last = time;
      mesh.visible = true;
      mesh.position.set(place.x, place.y, place.z);
      mesh.lookAt(eyes.position.x, eyes.position.y, eyes.position.z);
    },
  };
}
