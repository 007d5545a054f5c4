import { Group, type Object3D } from 'three';
import { Body, type BodyEvents, type LoadNetwork } from 'threepoint';
import type { Calibration, EstimatorName, PaperMethod, TrackingFrame, UpperBodyPose } from 'threepoint/core';
import { ReplayedBody, type ReplayState } from 'threepoint/internal';
import type { Avatar } from 'threepoint/three';

interface SecondBodyOptions {
  readonly scene: Object3D;
  readonly calibration: Calibration;
  readonly estimator: EstimatorName;
  readonly networks: LoadNetwork<PaperMethod>;
  /** The replay that moves the body. */
  readonly replay: ReplayState;
  /** The distance of the second body to the right of the first [m]. */
  readonly aside: number;
  loadAvatar(): Promise<Avatar>;
  onFallback(event: BodyEvents['fallback']): void;
}

/** Another method's body of the same person, next to the first. */
export class SecondBody {
  readonly object = new Group();
  readonly #body: Body<PaperMethod>;
  readonly #replayed: ReplayedBody;
  #avatar: Avatar | null = null;
  #disposed = false;

  /** Resolves when the avatar is shown; rejects if it cannot be loaded. */
  readonly ready: Promise<void>;

  constructor({ scene, calibration, estimator, networks, replay, aside, loadAvatar, onFallback }: SecondBodyOptions) {
    this.#body = new Body({ calibration, estimator, networks });
    this.#body.addEventListener('fallback', (event) => {
      event.preventDefault();
      onFallback(event);
    });
    this.#replayed = new ReplayedBody(this.#body, replay);
    this.object.position.x = aside;
    scene.add(this.object);
    this.ready = loadAvatar().then((avatar) => {
      if (this.#disposed) return avatar.dispose();
      avatar.setCalibration(calibration);
      this.object.add(avatar.object);
      this.#avatar = avatar;
    });
  }

  /** The selected method, which may still be loading. */
  get estimator(): EstimatorName {
    return this.#body.selectedEstimator;
  }

  /** Updates the body to a frame and returns its pose; null: this method draws none. */
  update(frame: TrackingFrame): UpperBodyPose | null {
    const pose = this.#replayed.update(frame, null);
    if (pose) this.#avatar?.setPose(pose, frame.time);
    return pose?.body ?? null;
  }

  /** Call before a frame that does not follow the last one in time. */
  discontinuity(): void {
    this.#body.discontinuity();
  }

  dispose(): void {
    this.#disposed = true;
    this.#avatar?.dispose();
    this.object.removeFromParent();
    void this.#body.dispose();
  }
}
