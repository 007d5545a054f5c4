import { addScaled, dampVec3, forward, type Pose, rotate, type Vec3, vec3 } from 'threepoint/math';
import { showToEyesOnly } from 'threepoint/three';
import { drawText, fillRoundedRect, textWidth, vrColors } from './canvas-drawing';
import { createVrPanel } from './vr-panel';

const [width, height] = [1000, 96];
const readFor = 2.5;

/**
 * A panel that floats before the eyes, over all that lies between, and that no mirror shows. `away`, `below`: the
 * distance along a direction from the eyes, and below them there [m]. `halfLife` of its motion after them [s]: a glance
 * at it does not move it away.
 */
export function createFloatingPanel(
  panel: ReturnType<typeof createVrPanel>,
  { away, below, halfLife }: { readonly away: number; readonly below: number; readonly halfLife: number },
) {
  const { mesh } = panel;
  mesh.renderOrder = 20;
  mesh.visible = false;
  mesh.material.depthTest = false;
  showToEyesOnly(mesh);
  let place: Vec3 | null = null;
  let last = 0;
  return {
    /** Shows the panel at this time [s] in a direction from these eyes, floor frame. */
    show(time: number, eyes: Vec3, direction: Vec3): void {
      const goal = addScaled(addScaled(eyes, direction, away), vec3(0, -1, 0), below);
      place = place ? dampVec3(place, goal, halfLife, Math.max(0, time - last)) : goal;
      last = time;
      mesh.visible = true;
      mesh.position.copy(place);
      mesh.lookAt(eyes.x, eyes.y, eyes.z);
    },
    hide(): void {
      mesh.visible = false;
      place = null;
    },
  };
}

/** Shows captions of sounds in the headset: a line low in the view, for players without sound. */
export function createVrCaptions() {
  const panel = createVrPanel(width, height, 1100);
  panel.mesh.name = 'captions';
  // 13 degrees below the gaze.
  const floating = createFloatingPanel(panel, { away: 1.5, below: 0.35, halfLife: 0.12 });
  let current: { readonly text: string; until: number | null } | null = null;

  return {
    object: panel.mesh,
    /** Shows a caption; an empty text hides it. */
    setText(text: string): void {
      current = text === '' ? null : { text, until: null };
      if (current === null) return;
      panel.draw((context) => {
        const wide = Math.min(width, textWidth(context, text, '600 46px') + 64);
        fillRoundedRect(context, [(width - wide) / 2, 4, wide, height - 8], 28, vrColors.glass);
        const writing = { font: '600 46px', color: vrColors.ink, align: 'center', baseline: 'middle' } as const;
        drawText(context, text, [width / 2, height / 2 + 2], { ...writing, maxWidth: width - 48 });
      });
    },
    /** Shows the caption at this time [s] before these eyes, floor frame; null: no user wears the headset. */
    show(time: number, eyes: Pose<'floor'> | null): void {
      if (current) current.until ??= time + readFor;
      if (!current?.until || time > current.until || !eyes) floating.hide();
      else floating.show(time, eyes.position, rotate(eyes.orientation, forward));
    },
  };
}
