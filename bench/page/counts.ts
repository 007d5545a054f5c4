import { createAvatar } from 'threepoint/avatar/avatar';
import { parseAvatar } from 'threepoint/avatar/load-avatar';
import { defaultCalibration } from 'threepoint/core/body/calibration';
import { createEstimator } from 'threepoint/core/estimation/estimators';
import { actorFrame } from 'threepoint/core/tracking/actor-motion';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { defaultSavings } from 'threepoint/xr/frame-rate';
import { requestVrSession } from 'threepoint/xr/request-session';
import { ArcheryPlay } from 'threepoint-page/archery/archery-play';
import { createArcheryView } from 'threepoint-page/archery/archery-view';
import { type Emulator, installEmulator } from 'threepoint-page/emulator/emulator';
import { type Picture, Stage } from 'threepoint-page/shell/stage';
import type { DrawnCounts, World, WorldCounts } from '../counts';
import { Court } from './court';
import { nextFrame } from './frame-times';
import { reportOutcome } from './outcome';
import { createSenders } from './senders';
import { TextureMemory } from './texture-memory';
import { withoutDevice } from './without-device';

const rateHz = 72;
/** Frames of a world that are counted: every so many, over a few seconds of motion. */
const countedFrames = 24;
const stride = 9;

/** A picture of the page's stage in an emulated headset with two eyes, at a headset's quality. */
class CountedStage {
  readonly stage: Stage;
  readonly #emulator: Emulator;
  readonly #textures: TextureMemory;
  readonly #estimator = createEstimator('ik', defaultCalibration);
  readonly #avatar: ReturnType<typeof createAvatar>;

  private constructor(
    stage: Stage,
    emulator: Emulator,
    textures: TextureMemory,
    avatar: ReturnType<typeof createAvatar>,
  ) {
    this.stage = stage;
    this.#emulator = emulator;
    this.#textures = textures;
    this.#avatar = avatar;
  }

  static async open(body: ArrayBuffer): Promise<CountedStage> {
    const canvas = document.createElement('canvas');
    document.body.append(canvas);
    const gl = canvas.getContext('webgl2', { antialias: true });
    if (!gl) throw new Error('no WebGL 2');
    const textures = new TextureMemory(gl);
    withoutDevice(gl);
    const emulator = await installEmulator();
    emulator.device.stereoEnabled = true;
    const stage = new Stage(canvas, 'high');
    await stage.renderer.xr.setSession(await requestVrSession());
    const avatar = createAvatar(await parseAvatar(body, 'body.vrm'));
    avatar.setCalibration(defaultCalibration);
    stage.studio.scene.add(avatar.object);
    return new CountedStage(stage, emulator, textures, avatar);
  }

  /** Draws frames of a world and returns the most that any of them took. */
  async count(mirror: boolean, frameAt: (index: number) => TrackingFrame): Promise<WorldCounts> {
    const most = { scene: none, shadows: none, mirror: none };
    const { stage } = this;
    const { renderer } = stage;
    let index = 0;
    let failure: unknown = null;
    renderer.setAnimationLoop(() => {
      try {
        const frame = frameAt(index);
        this.#emulator.drive(frame);
        this.#avatar.setPose(this.#estimator.update(frame).pose, frame.time);
        const shot: Picture = {
          time: frame.time,
          frame,
          avatar: this.#avatar,
          inSession: true,
          beside: 0,
          aside: 0,
          watched: null,
          mirror: mirror ? 'always' : 'never',
          savings: defaultSavings,
        };
        const draw = () => {
          stage.look(shot);
          stage.draw(shot);
          return { scene: { ...stage.drawn.scene }, mirror: { ...stage.drawn.mirror } };
        };
        const whole = draw();
        renderer.shadowMap.enabled = false;
        renderer.shadowMap.autoUpdate = false;
        const unshaded = draw();
        renderer.shadowMap.autoUpdate = true;
        renderer.shadowMap.enabled = true;
        most.scene = larger(most.scene, whole.scene);
        most.mirror = larger(most.mirror, whole.mirror);
        most.shadows = larger(most.shadows, {
          drawCalls: whole.scene.drawCalls - unshaded.scene.drawCalls,
          triangles: whole.scene.triangles - unshaded.scene.triangles,
        });
      } catch (error) {
        failure = error;
      }
      index += 1;
    });
    while (index < countedFrames && failure === null) await nextFrame();
    renderer.setAnimationLoop(null);
    if (failure) throw failure;
    return { ...most, texturesMB: Number(this.#textures.megabytes.toFixed(1)) };
  }
}

const none: DrawnCounts = { drawCalls: 0, triangles: 0 };
const larger = (a: DrawnCounts, b: DrawnCounts): DrawnCounts => ({
  drawCalls: Math.max(a.drawCalls, b.drawCalls),
  triangles: Math.max(a.triangles, b.triangles),
});

async function countArchery(counted: CountedStage): Promise<WorldCounts> {
  const { stage } = counted;
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
  const counts = await counted.count(true, () => {
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

async function countCourt(counted: CountedStage, mannequin: ArrayBuffer, people: number): Promise<WorldCounts> {
  const { studio } = counted.stage;
  const court = new Court(studio, mannequin, people, 'high');
  const { packetsAt, count } = createSenders(people - 1);
  for (let time = 0; !court.shows(count); time += 1 / rateHz) {
    court.receive(packetsAt(time), time);
    court.showOthers(time);
    await nextFrame();
    if (time > 40) throw new Error(`of ${count} others some never came`);
  }
  const counts = await counted.count(false, (index) => {
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
  const body = await (await fetch('/avatars/man.vrm')).arrayBuffer();
  const counted = await CountedStage.open(body);
  return {
    mirror: await counted.count(true, (index) => actorFrame((index * stride) / rateHz, defaultCalibration)),
    archery: await countArchery(counted),
    ball3: await countCourt(counted, body, 3),
    ball8: await countCourt(counted, body, 8),
    ball16: await countCourt(counted, body, 16),
  };
}

void reportOutcome(countWorlds);
