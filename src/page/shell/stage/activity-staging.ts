import type { Side } from 'threepoint/math';
import type { MouseAim } from 'threepoint-ui';
import type { OpenActivity } from '../../activity/activity';
import { type CameraScene, studioScene } from '../../scene/desktop-view';
import type { DrawingParts } from './drawing-parts';

/** The wishes of the mirror. */
const mirrorStaging: Pick<OpenActivity, 'scene' | 'mirrorSide' | 'palette' | 'watched'> = {
  scene: studioScene,
  mirrorSide: null,
};

/** Sets camera, mirror, colours and mouse as the current activity wishes, and only when a wish has changed. */
export class ActivityStaging {
  readonly #parts: DrawingParts;
  readonly #mouse: MouseAim;
  #scene: CameraScene = studioScene;
  #mirrorSide: Side | null = null;
  #palette: string | null = null;
  #steering = false;

  constructor(parts: DrawingParts, mouse: MouseAim) {
    this.#parts = parts;
    this.#mouse = mouse;
  }

  /** `current`: null at the mirror. `moveCamera`: also moves the camera to an unchanged scene. */
  arrange(current: OpenActivity | null, moveCamera = false): void {
    const { settings, headset, stage, avatar } = this.#parts;
    const { scene, mirrorSide, palette = null, watched = null } = current ?? mirrorStaging;
    const steering = current !== null && settings.mouse && !headset.worn && !watched;
    if (steering !== this.#steering) {
      this.#steering = steering;
      this.#mouse.setEnabled(steering);
      // A mouse that aims does not turn the camera.
      stage.view.setOrbit(!steering);
    }
    if (moveCamera || scene !== this.#scene) {
      this.#scene = scene;
      stage.view.setScene(scene);
    }
    if (mirrorSide !== this.#mirrorSide) {
      this.#mirrorSide = mirrorSide;
      stage.placeMirror(mirrorSide);
    }
    if (palette !== this.#palette) {
      this.#palette = palette;
      avatar.setSeatPalette(palette);
    }
  }
}
