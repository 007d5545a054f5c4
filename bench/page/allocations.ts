import { PerspectiveCamera } from 'three';
import { createBallView } from '../../src/app/ball/ball-view';
import { createStudio } from '../../src/app/studio/studio';
import { createAvatar } from '../../src/avatar/avatar';
import { parseAvatar } from '../../src/avatar/load-avatar';
import { createRemoteAvatars, type SeenPerson } from '../../src/avatar/remote-avatars';
import { defaultCalibration } from '../../src/core/body/calibration';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { createEstimator } from '../../src/core/estimation/estimators';
import { ballRules } from '../../src/core/games/ball/rules';
import { composeTransforms, invertTransform } from '../../src/core/math/pose';
import { decodePose } from '../../src/core/protocol/pose-codec';
import { actorFrame } from '../../src/core/tracking/actor-motion';
import { createInferenceWorker } from '../../src/inference/create-inference-worker';
import { loadRegressor } from '../../src/inference/load-regressor';
import { createRemotePlayers } from '../../src/net/remote-players';
import { createRenderer } from '../../src/scene/renderer';
import { arenaFromCirclePlace } from './circle';
import { createSenders } from './senders';

/** What is measured on this page; the real page is measured as it is. */
export type AllocationScene = 'ik' | 'paper' | 'learned' | 'ball8' | 'stillScene';

declare global {
  interface Window {
    /** Draws or estimates so often, once for each animation frame; resolves to how often that was. */
    runFrames?: (frames: number) => Promise<number>;
  }
}

const rateHz = 60;
/** Frames that are made before anything is measured; those after them begin anew. */
const preparedFrames = 1200;
const packetHz = 30;
const bodies = 8;

type FrameOf = (index: number) => void;

/** Estimates alone, of frames that were there before. */
async function estimates(name: 'ik' | 'paper' | 'learned'): Promise<FrameOf> {
  const regressor =
    name === 'ik' ? null : await loadRegressor(`/models/${name}.json`, { createWorker: createInferenceWorker });
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
  const canvas = document.querySelector('canvas');
  if (!canvas) throw new Error('no canvas');
  const renderer = createRenderer(canvas, 'low');
  renderer.setSize(480, 270, false);
  const studio = createStudio(renderer, 'low');
  const camera = new PerspectiveCamera(42, 480 / 270, 0.05, 90);
  camera.position.set(1.2, 2.1, 3.4);
  camera.lookAt(0, 0.9, -2.5);
  return { studio, draw: () => renderer.render(studio.scene, camera) };
}

function stillScene(): FrameOf {
  return picture().draw;
}

/** A court of eight: one's own body, and seven whose packets arrive. */
async function crowd(): Promise<FrameOf> {
  const { studio, draw } = picture();
  const view = createBallView({ quality: 'low', balls: 20, onCaption: () => undefined });
  const floorFromArena = invertTransform(arenaFromCirclePlace(0, bodies));
  studio.setSurroundings(view.placed(floorFromArena));
  const avatar = createAvatar(
    await parseAvatar(await (await fetch('/avatars/mannequin.vrm')).arrayBuffer(), 'mannequin.vrm'),
  );
  avatar.fitTo(defaultCalibration);
  const others = createRemoteAvatars(await (await fetch('/avatars/mannequin.vrm')).arrayBuffer(), 'mannequin.vrm');
  studio.scene.add(avatar.object, others.object);
  const estimator = createEstimator('ik', defaultCalibration);
  const senders = createSenders(bodies - 1);
  const skeleton = skeletonFromCalibration(defaultCalibration);
  const frames = Array.from({ length: preparedFrames }, (_, i) => actorFrame(i / rateHz, defaultCalibration));
  const packets = Array.from({ length: (preparedFrames * packetHz) / rateHz }, (_, i) =>
    senders.packetsAt(i / packetHz),
  );
  const state = ballRules.start(['a', 'b', 'c'], 1);
  const players = createRemotePlayers();
  const attendants = [null, null, null];
  const placements = Array.from({ length: bodies }, (_, seat) =>
    composeTransforms(floorFromArena, arenaFromCirclePlace(seat, bodies)),
  );
  return (index) => {
    const time = index / rateHz;
    const frame = frames[index % preparedFrames];
    const due = index % (rateHz / packetHz) === 0 ? packets[(index % preparedFrames) / (rateHz / packetHz)] : undefined;
    if (!frame) return;
    avatar.apply(estimator.update(frame).pose, time);
    for (const { seat, bytes } of due ?? []) {
      const packet = decodePose(bytes, skeleton);
      // The recording begins anew now and then; the sender's clock goes on.
      const timeMs = Math.round(time * 1000) & 0xffff;
      if (packet) players.receive({ seat, packet: { ...packet, timeMs }, arrivedAt: time });
    }
    const people = players.follow(time).map(
      ({ seat, pose, grips, opacity }): SeenPerson => ({
        id: seat,
        calibration: defaultCalibration,
        palette: 'ember',
        pose,
        placement: placements[seat] ?? (floorFromArena as never),
        grips,
        opacity,
      }),
    );
    others.show(people, time);
    view.show({
      state,
      time,
      attendants,
      me: null,
      rotate: false,
      opening: null,
      aim: null,
      secondsLeft: 90,
      pageTime: time,
      inRoom: true,
      acting: true,
      paused: false,
      head: frame.head,
    });
    draw();
  };
}

/** The frame of a scene by its name. */
function frameOf(scene: string | null): Promise<FrameOf> | FrameOf {
  if (scene === 'ik' || scene === 'paper' || scene === 'learned') return estimates(scene);
  if (scene === 'ball8') return crowd();
  if (scene === 'stillScene') return stillScene();
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

start().catch((error: unknown) => {
  window.benchError = error instanceof Error ? (error.stack ?? error.message) : String(error);
});
