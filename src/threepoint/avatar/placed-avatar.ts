import { Group, type Mesh, type MeshBasicMaterial, type PlaneGeometry } from 'three';
import { type Calibration, sameMeasures } from '../core/body/calibration';
import type { RemotePerson } from '../core/body/remote-person';
import type { Avatar } from './avatar';
import { createBlobShadow } from './blob-shadow';

/** An avatar on the floor of another person. Measures and opacity are set only when they change. */
export class PlacedAvatar {
  readonly avatar: Avatar;
  /** The person's floor, invisible at first; the caller places it. */
  readonly place = new Group();
  readonly #shadow: Mesh<PlaneGeometry, MeshBasicMaterial> | null;
  #fitted: Calibration | null = null;
  #opacity = 1;

  /** `shadow`: whether a soft shadow lies under the body. */
  constructor(avatar: Avatar, shadow: boolean) {
    this.avatar = avatar;
    this.#shadow = shadow ? createBlobShadow() : null;
    this.place.visible = false;
    this.place.add(avatar.object);
    if (this.#shadow) this.place.add(this.#shadow);
  }

  /** Poses the avatar at a time [s]. `mouth`: 0 shut to 1. */
  draw(
    { calibration, pose, opacity }: Pick<RemotePerson, 'calibration' | 'pose' | 'opacity'>,
    mouth: number,
    time: number,
  ): void {
    const { avatar } = this;
    if (!this.#fitted || !sameMeasures(this.#fitted, calibration)) {
      this.#fitted = calibration;
      avatar.setCalibration(calibration);
    }
    if (opacity !== this.#opacity) {
      this.#opacity = opacity;
      avatar.setOpacity(opacity);
      if (this.#shadow) this.#shadow.visible = opacity > 0.5;
    }
    avatar.setMouth(mouth);
    avatar.setPose(pose, time);
    if (!this.#shadow) return;
    const { hips, head } = avatar.jointPositions();
    const over = hips ?? head;
    if (over) this.#shadow.position.set(over.x, this.#shadow.position.y, over.z);
  }

  dispose(): void {
    this.place.removeFromParent();
    this.avatar.dispose();
    this.#shadow?.geometry.dispose();
    this.#shadow?.material.dispose();
  }
}
