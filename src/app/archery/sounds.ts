import type { ArcheryEvent, ArcheryState, Arrow } from '../../core/games/archery/archery-state';
import { maximumDraw } from '../../core/games/archery/bow';
import type { BowCue } from '../../core/games/archery/gestures';
import { positionAt } from '../../core/games/ballistics';
import { clamp } from '../../core/math/damper';
import { invertTransform, type Pose, type Transform, transformPoint, transformPose } from '../../core/math/pose';
import { length, type Vec3, vec3 } from '../../core/math/vec3';
import { createSoundStage, type Player, type Recipe, type Recipes } from '../../scene/sound/sound-stage';
import { bell, chime, click, warning, whoosh } from '../../scene/sound/synthesis';
import { cueCaption, eventCaption } from './captions';
import { creak, earth, rattle, thud, twang } from './synthesis';

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

/** Steps of the draw for which creak and twang are rendered. */
const drawSteps = 8;

const creakName = (share: number): string => `creak ${share}`;
const twangName = (share: number): string => `twang ${share}`;
/** There is a chime for each target of the game; other scores have that of the nearest. */
const chimeName = (points: number): string => `chime ${clamp(5 * Math.round(points / 5), 5, 20)}`;

/** All that is played, by name. */
const recipes: Recipes = new Map<string, Recipe>([
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

export function createSounds({ floorFromArena, onCaption, createContext }: SoundsOptions): Sounds {
  const arenaFromFloor = invertTransform(floorFromArena);
  const inFloor = (point: Vec3) => transformPoint(floorFromArena, point);
  const stage = createSoundStage(recipes, createContext);
  let head: Pose<'floor'> = { position: vec3(0, 1.6, 0), orientation: { x: 0, y: 0, z: 0, w: 1 } };
  /** The sound of each arrow in the air. */
  const flying = new Map<number, AudioBufferSourceNode>();
  let creaked = false;

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
    unlock: stage.unlock,
    hear(state, events, cues) {
      const playing = stage.player;
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
      stage.listen(next);
    },
    setVolume: stage.setVolume,
    setMuted: stage.setMuted,
    dispose: stage.dispose,
  };
}
