import { createBallView } from '../../src/app/ball/ball-view';
import { createRemoteAvatars, type SeenPerson } from '../../src/avatar/remote-avatars';
import { defaultCalibration } from '../../src/core/body/calibration';
import { type EstimatorName, estimatorNames } from '../../src/core/estimation/pose-estimator';
import { ballRules } from '../../src/core/games/ball/rules';
import { composeTransforms, invertTransform } from '../../src/core/math/pose';
import { decodePose } from '../../src/core/protocol/pose-codec';
import { actorFrame } from '../../src/core/tracking/actor-motion';
import { createRemotePlayers } from '../../src/net/remote-players';
import type { ArcheryStage } from './archery';
import { arenaFromCirclePlace } from './circle';
import { type FrameTimes, frameTimes } from './frame-times';
import { createSenders } from './senders';

/** Avatars in all, one's own among them, and what each of the others costs on the page's thread: median and p95 [ms per frame]. */
export interface CourtTimes extends FrameTimes {
  readonly avatars: number;
  /** Packets decoded, played back and bent into a body; null with nobody else there. */
  readonly perRemoteMs: number | null;
  readonly perRemoteP95Ms: number | null;
}

const crowds = [1, 3, 8, 16] as const;
const settleFrames = 6;
const countedFrames = 48;
const rateHz = 60;
const packetHz = 30;

/** The court with 1, 3, 8 and 16 avatars and each estimator for one's own: the paper's table 6, and more. */
export async function measureCourt(
  stage: ArcheryStage & { readonly mannequin: ArrayBuffer },
): Promise<Record<EstimatorName, readonly CourtTimes[]>> {
  const { renderer, studio, avatar, mirror, camera, estimators, mannequin } = stage;
  const view = createBallView({ quality: 'low', balls: 20, onCaption: () => undefined });
  const own = arenaFromCirclePlace(0, 16);
  const floorFromArena = invertTransform(own);
  studio.setSurroundings(view.placed(floorFromArena));
  mirror.setVisible(false);
  const state = ballRules.start(['a', 'b', 'c'], 1);
  const others = createRemoteAvatars(mannequin, 'mannequin.vrm');
  studio.scene.add(others.object);
  camera.position.set(1.2, 2.1, 3.4);
  camera.lookAt(0, 0.9, -2.5);
  const gl = renderer.getContext();
  const pixel = new Uint8Array(4);
  const nextFrame = () => new Promise<number>((resolve) => requestAnimationFrame(resolve));
  const results = Object.fromEntries(estimatorNames.map((name) => [name, [] as CourtTimes[]])) as Record<
    EstimatorName,
    CourtTimes[]
  >;

  for (const avatars of crowds) {
    const senders = createSenders(avatars - 1);
    for (const name of estimatorNames) {
      const estimator = estimators[name];
      estimator.reset();
      const players = createRemotePlayers();
      const thread: number[] = [];
      const drawn: number[] = [];
      const remote: number[] = [];
      let sent = -1;
      let drawnAll = 0;
      // Bodies are made one after the other when they are first seen: they are waited for.
      for (let i = 0; drawnAll < settleFrames + countedFrames; i++) {
        await nextFrame();
        const time = i / rateHz;
        const due = Math.floor(time * packetHz) > sent ? senders.packetsAt(time) : [];
        if (due.length > 0) sent = Math.floor(time * packetHz);
        const started = performance.now();
        const frame = actorFrame(time, defaultCalibration);
        const { pose, request } = estimator.update(frame);
        avatar.apply(pose, frame.time);
        const receiving = performance.now();
        for (const { seat, bytes } of due) {
          const packet = decodePose(bytes, senders.skeleton);
          if (packet) players.receive({ seat, packet, arrivedAt: time });
        }
        const people = players.follow(time).map(
          ({ seat, pose, grips, opacity }): SeenPerson => ({
            id: seat,
            calibration: defaultCalibration,
            palette: 'ember',
            pose,
            placement: composeTransforms(floorFromArena, arenaFromCirclePlace(seat, 16)),
            grips,
            opacity,
          }),
        );
        others.show(people, time);
        const received = performance.now();
        view.show({
          state,
          time,
          attendants: [null, null, null],
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
        renderer.render(studio.scene, camera);
        void request?.ask();
        const ended = performance.now();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        const complete = people.length === avatars - 1 && people.every(({ id }) => others.jointsOf(id) !== null);
        if (i > 3000) throw new Error(`only ${people.length} of ${avatars - 1} others came`);
        if (!complete) continue;
        drawnAll += 1;
        if (drawnAll <= settleFrames) continue;
        thread.push(ended - started);
        drawn.push(performance.now() - started);
        if (avatars > 1) remote.push((received - receiving) / (avatars - 1));
      }
      const times = frameTimes(thread, drawn, thread.length);
      const sorted = [...remote].sort((a, b) => a - b);
      const at = (q: number) => Number((sorted[Math.floor(q * sorted.length)] ?? Number.NaN).toFixed(4));
      results[name].push({
        ...times,
        avatars,
        perRemoteMs: avatars > 1 ? at(0.5) : null,
        perRemoteP95Ms: avatars > 1 ? at(0.95) : null,
      });
    }
  }
  others.dispose();
  view.dispose();
  studio.setSurroundings(null);
  return results;
}
