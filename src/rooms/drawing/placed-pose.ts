import { type AvatarPose, jointNames, makeUpperBodyPose, type TrackedFeet } from 'threepoint/core';
import {
  copyQuat,
  type MutablePose,
  type MutableTrackedPose,
  makePose,
  makeTrackedPose,
  multiply,
  type Pose,
  type Side,
  type TrackedPose,
  type Transform,
  transformPoint,
  transformPose,
} from 'threepoint/math';

/** A buffer for a pose that is transformed from the user's floor to the scene's. */
export class PlacedPose implements AvatarPose {
  readonly head: MutableTrackedPose = makeTrackedPose();
  leftHand: TrackedPose | null = null;
  rightHand: TrackedPose | null = null;
  body: AvatarPose['body'] = null;
  feet: TrackedFeet | undefined;
  readonly #hands = { left: makeTrackedPose(), right: makeTrackedPose() };
  readonly #body = makeUpperBodyPose();
  readonly #feet: Record<Side, Pose<'floor'> | null> = { left: null, right: null };
  readonly #ankles: Readonly<Record<Side, MutablePose<'floor'>>> = { left: makePose(), right: makePose() };

  /** Transforms a pose from the user's floor frame to the scene's and writes it into the buffer. */
  place(sceneFromFloor: Transform<'floor', 'floor'>, { head, leftHand, rightHand, body, feet }: AvatarPose): this {
    placeTracked(sceneFromFloor, head, this.head);
    this.leftHand = leftHand && placeTracked(sceneFromFloor, leftHand, this.#hands.left);
    this.rightHand = rightHand && placeTracked(sceneFromFloor, rightHand, this.#hands.right);
    this.feet = feet && this.#placeFeet(sceneFromFloor, feet);
    this.body = body && this.#body;
    if (!body) return this;
    const { hipsPosition, localRotations } = this.#body;
    transformPoint(sceneFromFloor, body.hipsPosition, hipsPosition);
    for (let i = 0; i < jointNames.length; i++) {
      copyQuat(body.localRotations[jointNames[i]!], localRotations[jointNames[i]!]);
    }
    multiply(sceneFromFloor.orientation, body.localRotations.hips, localRotations.hips);
    return this;
  }

  #placeFeet(sceneFromFloor: Transform<'floor', 'floor'>, { left, right }: TrackedFeet): TrackedFeet {
    this.#feet.left = left && transformPose(sceneFromFloor, left, this.#ankles.left);
    this.#feet.right = right && transformPose(sceneFromFloor, right, this.#ankles.right);
    return this.#feet;
  }
}

function placeTracked(
  sceneFromFloor: Transform<'floor', 'floor'>,
  pose: TrackedPose,
  target: MutableTrackedPose,
): MutableTrackedPose {
  transformPose(sceneFromFloor, pose, target);
  target.tracking = pose.tracking;
  return target;
}
