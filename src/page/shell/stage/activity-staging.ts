import type { Side } from 'threepoint/math';
import type { MouseAim } from 'threepoint-ui';
import type { OpenActivity } from '../../activity/activity';
import { type CameraScene, studioScene } from '../../scene/desktop-view';
import type { SessionParts } from '../session/session-parts';
import type { Stage } from './stage';
import type { UserAvatar } from './user-avatar';

/** The wishes of the mirror. */
const mirrorStaging: Pick<OpenActivity, 'scene' | 'mirrorSide' | 'palette' | 'watched'> = {
  scene: studioScene,
  mirrorSide: null,
};

/** Sets camera, mirror, colours and mouse as the current activity wishes, and only when a wish has changed. */
export class ActivityStaging {
  readonly #parts: SessionParts;
  readonly #stage: Stage;
  readonly #avatar: UserAvatar;
  readonly #mouse: MouseAim;
  #scene: CameraScene = studioScene;
  #mirrorSide: Side | null = null;
  #palette: string | null = null;
  #steering = false;

  constructor(parts: SessionParts, stage: Stage, avatar: UserAvatar, mouse: MouseAim) {
    this.#parts = parts;
    this.#stage = stage;
    this.#avatar = avatar;
    this.#mouse = mouse;
  }

  /** `current`: null at the mirror. `moveCamera`: also moves the camera to an unchanged scene. */
  arrange(current: OpenActivity | null, moveCamera = false): void {
    const { settings, headset } = this.#parts;
    const stage = this.#stage;
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
      this.#avatar.setSeatPalette(palette);
    }
  }
}
