import { actorFrame, createEstimator, defaultCalibration } from 'threepoint/core';
import type { AllocationScene } from '../allocations';
import { Court } from './court';
import { reportOutcome } from './outcome';
import { createSenders } from './senders';
import { loadNetwork, openAvatar, openStudio } from './stage';

const rateHz = 60;
/** The number of frames that are prepared before the measurement; later frames repeat them. */
const preparedFrames = 1200;
const packetHz = 30;
const bodies = 8;

type FrameOf = (index: number) => void;

/** Estimates alone, of frames that were there before. */
async function estimates(name: 'ik' | 'paper' | 'learned'): Promise<FrameOf> {
  const regressor = name === 'ik' ? null : await loadNetwork(name);
  const estimator = createEstimator(name, defaultCalibration, regressor);
  const frames = Array.from({ length: preparedFrames }, (_, i) => actorFrame(i / rateHz, defaultCalibration));
  return (index) => {
    const frame = frames[index % preparedFrames]!;
    if (index % preparedFrames === 0) estimator.reset();
    void estimator.update(frame).request?.ask();
  };
}

/** A court of eight: one's own body, and seven whose packets arrive. */
async function crowd(): Promise<FrameOf> {
  const { renderer, studio, camera } = openStudio();
  camera.position.set(1.2, 2.1, 3.4);
  camera.lookAt(0, 0.9, -2.5);
  const { avatar, file } = await openAvatar(studio.scene);
  const court = new Court(studio, file, bodies);
  const estimator = createEstimator('ik', defaultCalibration);
  const senders = createSenders(bodies - 1);
  const frames = Array.from({ length: preparedFrames }, (_, i) => actorFrame(i / rateHz, defaultCalibration));
  const framesPerPacket = rateHz / packetHz;
  const packets = Array.from({ length: preparedFrames / framesPerPacket }, (_, i) => senders.packetsAt(i / packetHz));
  return (index) => {
    const time = index / rateHz;
    const frame = frames[index % preparedFrames]!;
    avatar.setPose(estimator.update(frame).pose, time);
    if (index % framesPerPacket === 0) court.receive(packets[(index % preparedFrames) / framesPerPacket]!, time);
    court.showOthers(time);
    court.showCourt(time, frame.head);
    renderer.render(studio.scene, camera);
  };
}

async function start(): Promise<void> {
  const scene = new URLSearchParams(location.search).get('scene') as AllocationScene;
  const draw = await (scene === 'ball8' ? crowd() : estimates(scene));
  let index = 0;
  // A callback for each frame: promises would be garbage that no page makes.
  window.runFrames = (frames) =>
    new Promise((resolve, reject) => {
      const end = index + frames;
      const next = () => {
        try {
          draw(index);
        } catch (error) {
          reject(error);
          return;
        }
        index += 1;
        if (index < end) requestAnimationFrame(next);
        else resolve();
      };
      requestAnimationFrame(next);
    });
}

void reportOutcome(start);
