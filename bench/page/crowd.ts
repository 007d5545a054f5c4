import { actorFrame, createEstimator, defaultCalibration } from 'threepoint/core';
import { median } from 'threepoint/math';
import { mean } from '../../src/threepoint/core/math/statistics';
import { Court } from './court';
import { nextFrame } from './frame-times';
import { createSenders } from './senders';
import { openPicture, withoutDevice } from './stage';

/** What fifteen others cost the page's thread beyond the own body, frames of 72 Hz, medians [ms]. */
export interface CrowdTimes {
  readonly others: number;
  /** A frame with the own body alone. */
  readonly aloneMs: number;
  /** What a frame takes longer with the others: of pairs of blocks. */
  readonly beyondMs: number;
  /** Parts of that time: decoding of packets (450 a second), playback and posing of bodies, and drawing by three.js. */
  readonly receivedMs: number;
  readonly bentMs: number;
  readonly drawnMs: number;
}

const others = 15;
const rateHz = 72;
const packetHz = 30;
const blockFrames = 36;
/** Frames of a block that count come after these. */
const settleFrames = 6;
const rounds = 30;

/**
 * Frames with everyone and with the own body alone, block by block in turns, so that what else the machine does meets
 * both.
 */
export async function measureSixteen(): Promise<CrowdTimes> {
  const { renderer, studio, mirror, avatar, camera, mannequin } = await openPicture();
  const court = new Court(studio, mannequin, others + 1);
  mirror.setVisible(false);
  camera.position.set(1.2, 2.1, 3.4);
  camera.lookAt(0, 0.9, -2.5);
  withoutDevice(renderer.getContext());
  const { packetsAt } = createSenders(others);
  const estimator = createEstimator('ik', defaultCalibration);
  let frames = 0;
  let sent = -1;

  /** One frame; milliseconds: of all, of receiving, of bending. */
  function draw(everyone: boolean): readonly [all: number, received: number, bent: number] {
    const time = frames / rateHz;
    frames += 1;
    const due = Math.floor(time * packetHz) > sent;
    if (due) sent = Math.floor(time * packetHz);
    const packets = due && everyone ? packetsAt(time) : [];
    const frame = actorFrame(time, defaultCalibration);
    const started = performance.now();
    avatar.setPose(estimator.update(frame).pose, frame.time);
    const own = performance.now();
    court.receive(packets, time);
    const received = performance.now();
    if (everyone) court.showOthers(time);
    else court.hideOthers(time);
    const bent = performance.now();
    court.showCourt(time, frame.head);
    renderer.render(studio.scene, camera);
    return [performance.now() - started, received - own, bent - received];
  }

  while (!court.shows(others)) {
    await nextFrame();
    if (frames > 3000) throw new Error(`of ${others} others some never came`);
    draw(true);
  }
  const blocks: Record<'alone' | 'all' | 'received' | 'bent', number[]> = {
    alone: [],
    all: [],
    received: [],
    bent: [],
  };
  for (let round = 0; round < rounds; round++) {
    for (const everyone of round % 2 ? [true, false] : [false, true]) {
      const times: (readonly [number, number, number])[] = [];
      for (let i = 0; i < settleFrames + blockFrames; i++) {
        await nextFrame();
        const spent = draw(everyone);
        if (i >= settleFrames) times.push(spent);
      }
      blocks[everyone ? 'all' : 'alone'].push(median(times.map(([all]) => all)));
      if (!everyone) continue;
      blocks.received.push(mean(times.map(([, received]) => received)));
      blocks.bent.push(median(times.map(([, , bent]) => bent)));
    }
  }
  court.dispose();
  const round = (value: number): number => Number(value.toFixed(3));
  const [receivedMs, bentMs] = [median(blocks.received), median(blocks.bent)];
  const beyondMs = median(blocks.all.map((all, i) => all - blocks.alone[i]!));
  return {
    others,
    aloneMs: round(median(blocks.alone)),
    beyondMs: round(beyondMs),
    receivedMs: round(receivedMs),
    bentMs: round(bentMs),
    drawnMs: round(beyondMs - receivedMs - bentMs),
  };
}
