import { actorFrame, createEstimator, defaultCalibration } from 'threepoint/core';
import { Mirror } from 'threepoint/three';
import { TrackedSession } from 'threepoint/webxr';
import { Court } from './court';
import { reportOutcome } from './outcome';
import { createSenders } from './senders';
import { loadNetwork, openAvatar, openStudio } from './stage';
import { trackedHandsDevice } from './tracked-hands';

/**
 * What is measured on this page; the real page is measured as it is. An estimator: one estimate of one body, nothing
 * else. ball8: a court with seven others whose packets come 30 times a second: received, decoded, played back, bent,
 * drawn. hands: one's own body before the mirror with both hands tracked: the device's own poses were there before.
 * stillScene: what three.js leaves for drawing an arena that nothing moves in.
 */
export type AllocationScene = 'ik' | 'paper' | 'learned' | 'ball8' | 'hands' | 'stillScene';

declare global {
  interface Window {
    /** Draws or estimates so often, once for each animation frame; resolves to how often that was. */
    runFrames?: (frames: number) => Promise<number>;
  }
}

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
    const frame = frames[index % preparedFrames];
    if (!frame) return;
    if (index % preparedFrames === 0) estimator.reset();
    void estimator.update(frame).request?.ask();
  };
}

function picture() {
  const { renderer, studio, camera } = openStudio();
  camera.position.set(1.2, 2.1, 3.4);
  camera.lookAt(0, 0.9, -2.5);
  return { renderer, studio, camera, draw: () => renderer.render(studio.scene, camera) };
}

/** A court of eight: one's own body, and seven whose packets arrive. */
async function crowd(): Promise<FrameOf> {
  const { studio, draw } = picture();
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
    draw();
  };
}

/** One's own body before the mirror, its hands tracked: read, estimated, bent finger by finger, drawn twice. */
async function hands(): Promise<FrameOf> {
  const { renderer, studio, camera, draw } = picture();
  const { avatar } = await openAvatar(studio.scene);
  const mirror = new Mirror({ distance: 1.5, resolution: 256, samples: 0 });
  studio.scene.add(mirror.object);
  const estimator = createEstimator('ik', defaultCalibration);
  const moves = Array.from({ length: preparedFrames }, (_, i) => actorFrame(i / rateHz, defaultCalibration));
  const device = trackedHandsDevice(moves);
  const tracker = new TrackedSession(device);
  return (index) => {
    const time = index / rateHz;
    const frame = tracker.read(device.at(index), time);
    if (!frame) throw new Error('the device sees no head');
    avatar.setFingers('left', frame.fingers?.left ?? null);
    avatar.setFingers('right', frame.fingers?.right ?? null);
    avatar.setPose(estimator.update(frame).pose, time);
    mirror.reflect(renderer, studio.scene, camera, time);
    draw();
  };
}

/** The frame of a scene by its name. */
function frameOf(scene: string | null): Promise<FrameOf> | FrameOf {
  if (scene === 'ik' || scene === 'paper' || scene === 'learned') return estimates(scene);
  if (scene === 'ball8') return crowd();
  if (scene === 'hands') return hands();
  if (scene === 'stillScene') return picture().draw;
  throw new Error(`the address asks for the scene ${scene}`);
}

async function start(): Promise<void> {
  const draw = await frameOf(new URLSearchParams(location.search).get('scene'));
  let index = 0;
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
        else resolve(frames);
      };
      requestAnimationFrame(next);
    });
}

void reportOutcome(start);
