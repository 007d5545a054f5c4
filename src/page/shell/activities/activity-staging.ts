import type { Side } from 'threepoint/math';
import type { MouseAim } from 'threepoint-ui';
import type { OpenActivity } from '../../activity/activity';
import type { ActivityServices } from '../../activity/activity-context';
import { type CameraScene, studioScene } from '../../scene/desktop-view';
import type { Stage } from '../stage';

export interface StagingOptions {
  readonly services: Pick<ActivityServices, 'settings' | 'headset'>;
  readonly stage: {
    readonly view: Pick<Stage['view'], 'setScene' | 'setOrbit'>;
    readonly placeMirror: Stage['placeMirror'];
  };
  readonly mouse: Pick<MouseAim, 'setEnabled'>;
  /** Gives the user's avatar this palette; null: the user's own choice. */
  setPalette(palette: string | null): void;
}

/** The wishes of the mirror. */
const mirrorStaging: Pick<OpenActivity, 'scene' | 'mirrorSide' | 'palette' | 'watched'> = {
  scene: studioScene,
  mirrorSide: null,
};

/** Sets camera, mirror, colours and mouse as the current activity wishes, and only when a wish has changed. */
export class ActivityStaging {
  readonly #options: StagingOptions;
  #scene: CameraScene = studioScene;
  #mirrorSide: Side | null = null;
  #palette: string | null = null;
  #steering = false;

  constructor(options: StagingOptions) {
    this.#options = options;
  }

  /** `current`: null at the mirror. `moveCamera`: also moves the camera to an unchanged scene. */
  arrange(current: OpenActivity | null, moveCamera = false): void {
    const { stage, setPalette, mouse, services } = this.#options;
    const { scene, mirrorSide, palette = null, watched = null } = current ?? mirrorStaging;
    const steering = current !== null && services.settings.mouse && !services.headset.worn && !watched;
    if (steering !== this.#steering) {
      this.#steering = steering;
      mouse.setEnabled(steering);
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
      setPalette(palette);
    }
  }
}
