import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import type { Fingers } from 'threepoint/core/body/hand-shape';

/** Returns a pose with these fingers. It reads both on each access. */
export const withFingers = (of: { readonly pose: AvatarPose; readonly fingers: Fingers }): AvatarPose => ({
  get head() {
    return of.pose.head;
  },
  get leftHand() {
    return of.pose.leftHand;
  },
  get rightHand() {
    return of.pose.rightHand;
  },
  get body() {
    return of.pose.body;
  },
  get feet() {
    return of.pose.feet;
  },
  fingers: of.fingers,
});
