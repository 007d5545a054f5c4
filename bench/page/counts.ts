import { actorFrame, createEstimator, defaultCalibration, type TrackingFrame } from 'threepoint/core';
import { defaultSavings, requestVrSession } from 'threepoint/internal';
import { ArcheryPlay } from '../../src/page/archery/archery-play';
import { createArcheryView } from '../../src/page/archery/archery-view';
import { installEmulator } from '../../src/page/emulator/emulator';
import { type Picture, Stage } from '../../src/page/shell/stage/stage';
import type { World, WorldCounts } from '../counts';
import { Court } from './court';
import { nextFrame } from './frame-times';
import { reportOutcome } from './outcome';
import { createSenders } from './senders';
import { openAvatar, withoutDevice } from './stage';
import { TextureMemory } from './texture-memory';

const rateHz = 72;
/** Frames of a world that are counted: every so many, over a few seconds of motion. */
const countedFrames = 24;
const stride = 9;

type CountedStage = Awaited<ReturnType<typeof openStage>>;

/** Opens the page's stage in an emulated headset with two eyes, at a headset's quality, with an avatar. */
async function openStage() {
  const canvas = document.createElement('canvas');
  document.body.append(canvas);
  const gl = canvas.getContext('webgl2', { antialias: true });
  if (!gl) throw new Error('no WebGL 2');
  const textures = new TextureMemory(gl);
  withoutDevice(gl);
  const emulator = await installEmulator();
  emulator.device.stereoEnabled = true;
  const stage = new Stage(canvas, 'high');
  await stage.studio.openWindows();
  const { renderer } = stage;
  await renderer.xr.setSession(await requestVrSession());
  const estimator = createEstimator('ik', defaultCalibration);
  const { avatar, file: body } = await openAvatar(stage.studio.scene, 'man');

  /** Draws frames of a world and returns the most that any of them took. */
  async function count(mirror: boolean, frameAt: (index: number) => TrackingFrame): Promise<WorldCounts> {
    const most = { drawCalls: 0, triangles: 0 };
    let index = 0;
    let failure: unknown = null;
    const countFrame = () => {
      const frame = frameAt(index);
      emulator.drive(frame);
      avatar.setPose(estimator.update(frame).pose, frame.time);
      const picture: Picture = {
        time: frame.time,
        frame,
        avatar,
        inSession: true,
        beside: 0,
        span: { from: 0, to: 0 },
        watched: null,
        mirror: mirror ? 'always' : 'never',
        savings: defaultSavings,
      };
      stage.look(picture);
      stage.draw(picture);
      const { scene, mirror: reflections } = stage.drawn;
      for (const what of ['drawCalls', 'triangles'] as const)
        most[what] = Math.max(most[what], scene[what] + reflections[what]);
    };
    renderer.setAnimationLoop(() => {
      try {
        countFrame();
      } catch (error) {
        failure = error;
      }
      index += 1;
    });
    while (index < countedFrames && failure === null) await nextFrame();
    renderer.setAnimationLoop(null);
    if (failure) throw failure;
    return { ...most, texturesMB: Number(textures.megabytes.toFixed(1)) };
  }

  return { stage, body, count };
}

async function countArchery({ stage, count }: CountedStage): Promise<WorldCounts> {
  const settings = { bowSide: 'left', oneHanded: false, everyHitCounts: false } as const;
  const play = new ArcheryPlay(
    defaultCalibration,
    () => settings,
    () => 7,
  );
  const view = createArcheryView({
    quality: 'high',
    distances: play.targets.map(({ distance }) => distance),
    onCaption: () => undefined,
  });
  stage.studio.setSurroundings(view.range);
  stage.studio.scene.add(view.bow);
  stage.placeMirror('right');
  let played = 0;
  const counts = await count(true, () => {
    const round = () => {
      const { frame, buttons } = play.act(played++ / rateHz);
      return { frame, shown: play.follow(frame, buttons) };
    };
    let now = round();
    for (let i = 1; i < 100; i++) {
      view.playEvents(now.shown.events, now.shown.cues);
      now = round();
    }
    view.show(now.shown.state, now.shown.bow, now.shown.time, now.frame.head);
    return now.frame;
  });
  view.bow.removeFromParent();
  view.dispose();
  stage.studio.setSurroundings(null);
  return counts;
}

async function countCourt({ stage, body, count }: CountedStage, people: number): Promise<WorldCounts> {
  const court = new Court(stage.studio, body, people, 'high');
  const others = people - 1;
  const { packetsAt } = createSenders(others);
  for (let time = 0; !court.shows(others); time += 1 / rateHz) {
    court.receive(packetsAt(time), time);
    court.showOthers(time);
    await nextFrame();
    if (time > 40) throw new Error(`of ${others} others some never came`);
  }
  const counts = await count(false, (index) => {
    const time = 60 + (index * stride) / rateHz;
    const frame = actorFrame(time, defaultCalibration);
    court.receive(packetsAt(time), time);
    court.showOthers(time);
    court.showCourt(time, frame.head);
    return frame;
  });
  court.dispose();
  return counts;
}

/** Counts what every world of the page draws in a headset of two eyes. Nothing reaches a graphics device. */
async function countWorlds(): Promise<Record<World, WorldCounts>> {
  const counted = await openStage();
  return {
    mirror: await counted.count(true, (index) => actorFrame((index * stride) / rateHz, defaultCalibration)),
    archery: await countArchery(counted),
    ball3: await countCourt(counted, 3),
    ball8: await countCourt(counted, 8),
    ball16: await countCourt(counted, 16),
  };
}

void reportOutcome(countWorlds);
