import type { ArcheryEvent, ArcheryState, Arrow } from '../../core/games/archery/archery-state';
import { maximumDraw } from '../../core/games/archery/bow';
import type { BowCue } from '../../core/games/archery/gestures';
import { positionAt } from '../../core/games/ballistics';
import { clamp } from '../../core/math/damper';
import { invertTransform, type Pose, type Transform, transformPoint, transformPose } from '../../core/math/pose';
import { rotate } from '../../core/math/quat';
import { length, type Vec3, vec3 } from '../../core/math/vec3';
import { cueCaption, eventCaption } from './captions';
import { bell, chime, click, creak, earth, rattle, thud, twang, warning, whoosh } from './synthesis';

/** What is heard of archery: from where it happens, and in words. */
export interface Sounds {
  /** Starts the audio; a browser allows it only within a user's gesture. Captions come without it. Rejects where there is no audio. */
  unlock(): Promise<void>;
  /** Plays and captions what happened in this frame; cues are in the floor frame, events in the arena frame. */
  hear(state: ArcheryState, events: readonly ArcheryEvent[], cues: readonly BowCue[]): void;
  /** Where the ears are, floor frame. */
  listen(head: Pose<'floor'>): void;
  /** 0 silent to 1. */
  setVolume(volume: number): void;
  setMuted(on: boolean): void;
  dispose(): void;
}

export interface SoundsOptions {
  readonly floorFromArena: Transform<'floor', 'arena'>;
  readonly onCaption: (text: string) => void;
  /** Made at the first `unlock`; default: the browser's own. */
  readonly createContext?: () => AudioContext;
}

/** Seconds in which volume and mute fade. */
const fadeSeconds = 0.03;
/** Steps of the draw for which creak and twang are rendered. */
const drawSteps = 8;

type Recipe = (rate: number) => Float32Array<ArrayBuffer>;

const creakName = (share: number): string => `creak ${share}`;
const twangName = (share: number): string => `twang ${share}`;
/** There is a chime for each target of the game; other scores have that of the nearest. */
const chimeName = (points: number): string => `chime ${clamp(5 * Math.round(points / 5), 5, 20)}`;

/** All that is played, by name. */
const recipes: ReadonlyMap<string, Recipe> = new Map<string, Recipe>([
  ...Object.entries({ bell, click, earth, rattle, thud, warning, whoosh }),
  ...Array.from({ length: drawSteps + 1 }, (_, step): [string, Recipe][] => {
    const share = step / drawSteps;
    return [
      [creakName(share), (rate) => creak(rate, share)],
      [twangName(share), (rate) => twang(rate, share)],
    ];
  }).flat(),
  ...[5, 10, 15, 20].map((points): [string, Recipe] => [chimeName(points), (rate) => chime(rate, points)]),
]);

function createPlayer(context: AudioContext) {
  const master = context.createGain();
  const limiter = context.createDynamicsCompressor();
  master.connect(limiter).connect(context.destination);
  const buffers = new Map<string, AudioBuffer>();

  /** Rendered once, at the context's own rate. */
  function buffer(name: string): AudioBuffer {
    const known = buffers.get(name);
    if (known) return known;
    const recipe = recipes.get(name);
    if (!recipe) throw new Error(`games/archery/sounds: there is no sound ${name}`);
    const samples = recipe(context.sampleRate);
    const made = context.createBuffer(1, samples.length, context.sampleRate);
    made.copyToChannel(samples, 0);
    buffers.set(name, made);
    return made;
  }

  /** Renders everything, one sound at a time with the page's own work between, so that no frame of the match has to. */
  async function warm(): Promise<void> {
    for (const name of recipes.keys()) {
      buffer(name);
      await new Promise((resolve) => setTimeout(resolve));
    }
  }

  /** Starts a sound at a point of the floor frame; the panner goes when the sound has ended. */
  function play(name: string, at: Vec3, delay = 0): { source: AudioBufferSourceNode; panner: PannerNode } {
    const source = context.createBufferSource();
    source.buffer = buffer(name);
    const panner = context.createPanner();
    panner.panningModel = 'HRTF';
    panner.distanceModel = 'inverse';
    panner.refDistance = 2;
    panner.rolloffFactor = 0.7;
    panner.positionX.value = at.x;
    panner.positionY.value = at.y;
    panner.positionZ.value = at.z;
    source.connect(panner).connect(master);
    source.addEventListener('ended', () => panner.disconnect());
    source.start(context.currentTime + delay);
    return { source, panner };
  }
  return { context, master, warm, play };
}

type Player = ReturnType<typeof createPlayer>;

function placeListener({ listener, currentTime }: AudioContext, head: Pose<'floor'>): void {
  const { x, y, z } = head.position;
  const ahead = rotate(head.orientation, vec3(0, 0, -1));
  const upward = rotate(head.orientation, vec3(0, 1, 0));
  // Some browsers only have the older methods.
  if (!listener.positionX) {
    listener.setPosition(x, y, z);
    listener.setOrientation(ahead.x, ahead.y, ahead.z, upward.x, upward.y, upward.z);
    return;
  }
  const values = [
    [listener.positionX, x],
    [listener.positionY, y],
    [listener.positionZ, z],
    [listener.forwardX, ahead.x],
    [listener.forwardY, ahead.y],
    [listener.forwardZ, ahead.z],
    [listener.upX, upward.x],
    [listener.upY, upward.y],
    [listener.upZ, upward.z],
  ] as const;
  for (const [parameter, value] of values) parameter.setValueAtTime(value, currentTime);
}

export function createSounds({
  floorFromArena,
  onCaption,
  createContext = () => new AudioContext(),
}: SoundsOptions): Sounds {
  const arenaFromFloor = invertTransform(floorFromArena);
  const inFloor = (point: Vec3) => transformPoint(floorFromArena, point);
  let player: Player | null = null;
  let volume = 0.8;
  let muted = false;
  let head: Pose<'floor'> = { position: vec3(0, 1.6, 0), orientation: { x: 0, y: 0, z: 0, w: 1 } };
  /** The sound of each arrow in the air. */
  const flying = new Map<number, AudioBufferSourceNode>();
  let creaked = false;

  const applyVolume = () => {
    if (player) player.master.gain.setTargetAtTime(muted ? 0 : volume, player.context.currentTime, fadeSeconds);
  };

  const drawShare = (draw: number) => Math.round(clamp(draw / maximumDraw, 0, 1) * drawSteps) / drawSteps;

  /** A whoosh that goes along with the arrow. */
  function follow({ id, release }: Arrow, { context, play }: Player): void {
    const { source, panner } = play('whoosh', inFloor(release.position));
    const speed = length(release.velocity);
    for (let step = 1; step <= 4; step++) {
      const after = (step / 4) * Math.min(0.7, 14 / speed);
      const at = inFloor(positionAt(release, after));
      panner.positionX.linearRampToValueAtTime(at.x, context.currentTime + after);
      panner.positionY.linearRampToValueAtTime(at.y, context.currentTime + after);
      panner.positionZ.linearRampToValueAtTime(at.z, context.currentTime + after);
    }
    flying.set(id, source);
    source.addEventListener('ended', () => flying.delete(id));
  }

  function playEvent(event: ArcheryEvent, playing: Player): void {
    const { play } = playing;
    if (event.type === 'released') follow(event.arrow, playing);
    else if (event.type === 'landed') {
      flying.get(event.arrow.id)?.stop();
      const { on, points, position } = event.landing;
      const at = inFloor(position);
      if (on === 'target') play('thud', at);
      else if (on === 'ground') play('earth', at);
      else play('rattle', at);
      // The chime is for the archer: it rings half way.
      const near = {
        x: (at.x + head.position.x) / 2,
        y: (at.y + head.position.y) / 2,
        z: (at.z + head.position.z) / 2,
      };
      if (points > 0) play(chimeName(points), near, 0.12);
    } else if (event.type === 'ended') play('bell', inFloor(vec3(-2, 2.4, -4)), 0.35);
    else if (event.type === 'left-zone') play('warning', inFloor(vec3(0, 0.3, 0)));
  }

  function playCue({ type, position, draw }: BowCue, { play }: Player): void {
    const share = drawShare(draw);
    if (type === 'creak') play(creakName(share), position);
    else if (type === 'released') play(twangName(share), position);
    else if (type === 'nocked' || type === 'taken' || type === 'cancelled') play('click', position);
    else if (type === 'lost') play('warning', position);
  }

  /** A bow creaks many times in a draw; it is said once. */
  function captionCue(cue: BowCue): void {
    if (cue.type === 'creak' && creaked) return;
    if (cue.type === 'creak') creaked = true;
    else if (cue.type === 'nocked' || cue.type === 'released' || cue.type === 'cancelled') creaked = false;
    const text = cueCaption(cue);
    if (text) onCaption(text);
  }

  return {
    async unlock() {
      if (!player) {
        player = createPlayer(createContext());
        player.master.gain.value = muted ? 0 : volume;
      }
      if (player.context.state !== 'running') await player.context.resume();
      await player.warm();
    },
    hear(state, events, cues) {
      // A context that rests would keep all of it and play it at once later.
      const playing = player?.context.state === 'running' ? player : null;
      const headInArena = transformPose(arenaFromFloor, head);
      for (const cue of cues) {
        captionCue(cue);
        if (playing) playCue(cue, playing);
      }
      for (const event of events) {
        onCaption(eventCaption(event, { targets: state.targets, seconds: state.options.seconds, head: headInArena }));
        if (playing) playEvent(event, playing);
      }
    },
    listen(next) {
      head = next;
      if (player) placeListener(player.context, next);
    },
    setVolume(next) {
      volume = Math.max(0, Math.min(1, next));
      applyVolume();
    },
    setMuted(on) {
      muted = on;
      applyVolume();
    },
    dispose() {
      void player?.context.close();
      player = null;
    },
  };
}
