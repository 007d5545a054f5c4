import { type AvatarPose, makeUpperBodyPose } from 'threepoint/core/body/avatar-pose';
import { jointNames } from 'threepoint/core/body/joints';
import {
  type MutableTrackedPose,
  makeTrackedPose,
  type TrackedPose,
  type Transform,
  transformPoint,
  transformPose,
} from 'threepoint/core/math/pose';
import { copyQuat, multiply } from 'threepoint/core/math/quat';

/** A buffer for a pose on a floor that the page has moved. */
export class PlacedPose implements AvatarPose {
  readonly head: MutableTrackedPose = makeTrackedPose();
  leftHand: TrackedPose | null = null;
  rightHand: TrackedPose | null = null;
  body: AvatarPose['body'] = null;
  readonly #hands = { left: makeTrackedPose(), right: makeTrackedPose() };
  readonly #body = makeUpperBodyPose();

  /** Writes a pose on the wearer's floor as one on the floor of the scene. */
  place(sceneFromFloor: Transform<'floor', 'floor'>, { head, leftHand, rightHand, body }: AvatarPose): this {
    placeTracked(sceneFromFloor, head, this.head);
    this.leftHand = leftHand && placeTracked(sceneFromFloor, leftHand, this.#hands.left);
    this.rightHand = rightHand && placeTracked(sceneFromFloor, rightHand, this.#hands.right);
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
