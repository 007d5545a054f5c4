/**
 * Hip joints beside the pelvis, knees, ankles, and how far the foot reaches, as shares of the eye height: those of the
 * mannequin (tools/avatars/build/rig/rig.ts), which stands on them.
 */
export const legProportions = { aside: 0.0566, hip: 0.5849, knee: 0.3176, ankle: 0.0516, foot: 0.13 };
