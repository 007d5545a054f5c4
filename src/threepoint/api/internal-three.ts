// "threepoint/internal/three": what the packages of this repository draw with besides the published entries. It is not
// published.
export { createAvatar, createAvatarBetweenFrames } from '../avatar/avatar';
export { bodyLabelOf, bodyLabels } from '../avatar/built-in-body-labels';
export { ContactShadow } from '../avatar/contact-shadow';
export { createDebugSkeleton } from '../avatar/debug-skeleton';
export { showToEyesOnly } from '../avatar/eye-layers';
export { GazeChoice, GazeTargets } from '../avatar/gaze-targets';
export { fingersFromButtons, handShapeFromButtons } from '../avatar/hands/button-fingers';
export { ObjectHolds } from '../avatar/hands/hold-object';
export { createHeadLossFade } from '../avatar/head-loss-fade';
export { Mirror } from '../avatar/mirror';
export { palettes, skinColors } from '../avatar/palettes';
export { RemoteAvatars } from '../avatar/remote-avatars';
export { thirdPersonOnlyLayer } from '../avatar/rig/body-meshes';
export { type ClothWeave, weaveCloth } from '../avatar/rig/cloth-weave';
export type { MeshSimplifier } from '../avatar/rig/distant-triangles';
