/**
 * The proportions of the mannequin's legs in eye heights (tools/avatars/build/rig.ts): the lateral offset of the
 * hip joint, the heights of hip, knee and ankle, and the length of the foot.
 */
export const legProportions = { aside: 0.0566, hip: 0.5849, knee: 0.3176, ankle: 0.0516, foot: 0.13 };
