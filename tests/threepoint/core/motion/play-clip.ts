import { type AnimationClip, AnimationMixer, LoopOnce, type Object3D } from 'three';

/** Plays a clip by three.js to any of its moments [s], the last one too. */
export function playerOf(root: Object3D, clip: AnimationClip): (time: number) => void {
  const mixer = new AnimationMixer(root);
  const action = mixer.clipAction(clip).setLoop(LoopOnce, 1);
  action.clampWhenFinished = true;
  return (time) => {
    action.reset().play();
    mixer.setTime(time);
    root.updateMatrixWorld(true);
  };
}
