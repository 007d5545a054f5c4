import { defaultCalibration, type EstimatorName, estimatorNames } from 'threepoint/core';
import { ArcheryPlay } from '../../src/page/archery/archery-play';
import { createArcheryView } from '../../src/page/archery/archery-view';
import { type FrameTimes, frameTimes, timeFrame } from './frame-times';
import type { BenchStage } from './stage';

/** Frame times of a whole round as in the paper's table 5, and its result: all play the same one to its end. */
export interface RoundTimes extends FrameTimes {
  readonly score: number;
}

/** Frames of one estimator in a row before the next takes its turn. */
const blockFrames = 60;
const settleFrames = 8;
/** The headset whose round it is. */
const rateHz = 72;
const longestRound = 40;

/** The built-in archer plays one round with each estimator, block by block in turns. */
export async function measureArchery(stage: BenchStage): Promise<Record<EstimatorName, RoundTimes>> {
  const { renderer, studio, avatar, mirror, camera, estimators } = stage;
  const settings = { bowSide: 'left', oneHanded: false, everyHitCounts: false } as const;
  const rounds = estimatorNames.map((name) => {
    const play = new ArcheryPlay(
      defaultCalibration,
      () => settings,
      () => 7,
    );
    return { name, play, frame: 0, thread: [] as number[], drawn: [] as number[] };
  });
  const view = createArcheryView({
    quality: 'low',
    distances: (rounds[0]?.play.targets ?? []).map(({ distance }) => distance),
    onCaption: () => undefined,
  });
  studio.setSurroundings(view.range);
  studio.scene.add(view.bow);
  mirror.place(1.95, -0.1, -1.3);
  camera.position.set(-1.35, 1.85, 3.3);
  camera.lookAt(0.15, 0.8, -2);

  const running = () =>
    rounds.filter(({ play, frame }) => play.newest?.state.phase !== 'over' && frame < longestRound * rateHz);
  while (running().length > 0) {
    for (const round of running()) {
      const estimator = estimators[round.name];
      estimator.reset();
      for (let i = 0; i < blockFrames && round.play.newest?.state.phase !== 'over'; i++) {
        const spent = await timeFrame(renderer, () => {
          const { frame, buttons } = round.play.act(round.frame / rateHz);
          const { state, bow, time, events, cues } = round.play.follow(frame, buttons);
          view.playEvents(events, cues);
          const { pose, request } = estimator.update(frame);
          avatar.setPose(pose, frame.time);
          view.show(state, bow, time, frame.head);
          mirror.reflect(renderer, studio.scene, camera, frame.time);
          renderer.render(studio.scene, camera);
          void request?.ask();
        });
        round.frame += 1;
        if (i < settleFrames) continue;
        round.thread.push(spent.thread);
        round.drawn.push(spent.drawn);
      }
    }
  }
  view.bow.removeFromParent();
  view.dispose();
  studio.setSurroundings(null);
  return Object.fromEntries(
    rounds.map(({ name, play, frame, thread, drawn }) => [
      name,
      { ...frameTimes(thread, drawn, frame), score: play.newest?.state.score ?? 0 },
    ]),
  ) as Record<EstimatorName, RoundTimes>;
}
