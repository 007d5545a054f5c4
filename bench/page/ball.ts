import { actorFrame, defaultCalibration, type EstimatorName, estimatorNames, recordOf } from 'threepoint/core';
import { quantile } from '../../src/threepoint/core/math/statistics';
import { Court } from './court';
import { type FrameTimes, frameTimes, timeFrame } from './frame-times';
import { createSenders } from './senders';
import type { BenchStage } from './stage';

/**
 * Avatars in all, one's own among them, and what each of the others costs on the page's thread: median and p95 [ms per
 * frame].
 */
export interface CourtTimes extends FrameTimes {
  readonly avatars: number;
  /** Packets decoded, played back and bent into a body; null where no one else is there. */
  readonly perRemoteMs: number | null;
  readonly perRemoteP95Ms: number | null;
}

const crowds = [1, 3, 8, 16] as const;
const settleFrames = 6;
const countedFrames = 48;
const rateHz = 60;
const packetHz = 30;

/** The court with 1, 3, 8 and 16 avatars and each estimator for one's own: the paper's table 6, and more. */
export async function measureCourt(stage: BenchStage): Promise<Record<EstimatorName, readonly CourtTimes[]>> {
  const { studio, mirror, camera, mannequin } = stage;
  const court = new Court(studio, mannequin, Math.max(...crowds));
  mirror.setVisible(false);
  camera.position.set(1.2, 2.1, 3.4);
  camera.lookAt(0, 0.9, -2.5);
  const results = recordOf(estimatorNames, (): CourtTimes[] => []);
  for (const avatars of crowds) {
    const senders = createSenders(avatars - 1);
    for (const name of estimatorNames) {
      court.clear();
      results[name].push(await measureCrowd(stage, court, name, senders));
    }
  }
  court.dispose();
  return results;
}

/** One's own body by this estimator, and a body for each of the senders. */
async function measureCrowd(
  { renderer, studio, avatar, camera, estimators }: BenchStage,
  court: Court,
  name: EstimatorName,
  { packetsAt, count }: ReturnType<typeof createSenders>,
): Promise<CourtTimes> {
  const estimator = estimators[name];
  estimator.reset();
  const thread: number[] = [];
  const drawn: number[] = [];
  const remote: number[] = [];
  let sent = -1;
  let complete = 0;
  for (let i = 0; complete < settleFrames + countedFrames; i++) {
    if (i > 3000) throw new Error(`of ${count} others some never came`);
    const time = i / rateHz;
    const due = Math.floor(time * packetHz) > sent ? packetsAt(time) : [];
    if (due.length > 0) sent = Math.floor(time * packetHz);
    let othersMs = 0;
    const spent = await timeFrame(renderer, () => {
      const frame = actorFrame(time, defaultCalibration);
      const { pose, request } = estimator.update(frame);
      avatar.setPose(pose, frame.time);
      const receiving = performance.now();
      court.receive(due, time);
      court.showOthers(time);
      othersMs = performance.now() - receiving;
      court.showCourt(time, frame.head);
      renderer.render(studio.scene, camera);
      void request?.ask();
    });
    if (!court.shows(count)) continue;
    complete += 1;
    if (complete <= settleFrames) continue;
    thread.push(spent.thread);
    drawn.push(spent.drawn);
    if (count > 0) remote.push(othersMs / count);
  }
  const at = (share: number) => Number(quantile(remote, share).toFixed(4));
  return {
    ...frameTimes(thread, drawn, thread.length),
    avatars: count + 1,
    perRemoteMs: count > 0 ? at(0.5) : null,
    perRemoteP95Ms: count > 0 ? at(0.95) : null,
  };
}
