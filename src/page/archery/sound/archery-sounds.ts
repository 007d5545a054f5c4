import { clamp, length, lerp, type Pose, vec3 } from 'threepoint/math';
import { positionAt } from 'threepoint-games';
import { type ArcheryEvent, type ArcheryState, type Arrow, type BowCue, maximumDraw } from 'threepoint-games/archery';
import {
  createSoundStage,
  type Recipe,
  type Recipes,
  type SoundPlayer,
  type SoundStage,
} from '../../scene/sound/sound-stage';
import { bell, chime, click, warning, whoosh } from '../../scene/sound/sound-synthesis';
import { cueCaption, eventCaption } from './archery-captions';
import { creak, earth, rattle, thud, twang } from './archery-synthesis';

/** Steps of the draw for which creak and twang are rendered. */
const drawSteps = 8;

const creakName = (share: number): string => `creak ${share}`;
const twangName = (share: number): string => `twang ${share}`;
/** There is a chime for each target of the game; other scores have that of the nearest. */
const chimeName = (points: number): string => `chime ${clamp(5 * Math.round(points / 5), 5, 20)}`;

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

type Landed = Extract<ArcheryEvent, { type: 'landed' }>;

const drawFraction = (draw: number): number => Math.round(clamp(draw / maximumDraw, 0, 1) * drawSteps) / drawSteps;

function playCue({ type, position, draw }: BowCue, { play }: SoundPlayer): void {
  if (type === 'creak') play(creakName(drawFraction(draw)), position);
  else if (type === 'released') play(twangName(drawFraction(draw)), position);
  else if (type === 'nocked' || type === 'taken' || type === 'cancelled') play('click', position);
  else if (type === 'lost') play('warning', position);
}

/** Plays the sounds of archery from where they happen, with captions. The arena frame is the user's floor frame. */
export class ArcherySounds {
  readonly #onCaption: (text: string) => void;
  /** The stage that plays the sounds. It must be unlocked; captions work without it. */
  readonly stage: SoundStage;
  readonly #flying = new Map<number, AudioBufferSourceNode>();
  #head: Pose<'floor'> = { position: vec3(0, 1.6, 0), orientation: { x: 0, y: 0, z: 0, w: 1 } };
  /** The creaking of the bow was captioned in this draw. */
  #creaked = false;

  constructor(onCaption: (text: string) => void, createContext?: () => AudioContext) {
    this.#onCaption = onCaption;
    this.stage = createSoundStage(recipes, createContext);
  }

  /** Plays and captions what happened in this frame. */
  playEvents({ targets, options }: ArcheryState, events: readonly ArcheryEvent[], cues: readonly BowCue[]): void {
    const playing = this.stage.player;
    for (const cue of cues) {
      this.#captionCue(cue);
      if (playing) playCue(cue, playing);
    }
    if (events.length === 0) return;
    const { position, orientation } = this.#head;
    const head: Pose<'arena'> = { position, orientation };
    for (const event of events) {
      this.#onCaption(eventCaption(event, { targets, seconds: options.seconds, head }));
      if (playing) this.#playEvent(event, playing);
    }
  }

  /** Sets the pose of the listener's head, floor frame. */
  setListener(head: Pose<'floor'>): void {
    this.#head = head;
    this.stage.setListener(head);
  }

  dispose(): void {
    this.stage.dispose();
  }

  /** Captions a cue. A bow creaks many times in a draw; one caption is enough. */
  #captionCue(cue: BowCue): void {
    if (cue.type === 'creak' && this.#creaked) return;
    if (cue.type === 'creak') this.#creaked = true;
    else if (cue.type === 'nocked' || cue.type === 'released' || cue.type === 'cancelled') this.#creaked = false;
    const text = cueCaption(cue);
    if (text) this.#onCaption(text);
  }

  #playEvent(event: ArcheryEvent, playing: SoundPlayer): void {
    if (event.type === 'released') this.#playFlight(event.arrow, playing);
    else if (event.type === 'landed') this.#playLanding(event, playing);
    else if (event.type === 'ended') playing.play('bell', vec3(-2, 2.4, -4), 0.35);
    else if (event.type === 'left-zone') playing.play('warning', vec3(0, 0.3, 0));
  }

  /** Plays a whoosh that moves with the arrow. */
  #playFlight({ id, release }: Arrow, { playAlong }: SoundPlayer): void {
    const seconds = Math.min(0.7, 14 / length(release.velocity));
    const source = playAlong('whoosh', seconds, (after) => positionAt(release, after));
    this.#flying.set(id, source);
    source.addEventListener('ended', () => this.#flying.delete(id));
  }

  #playLanding({ arrow, landing }: Landed, { play }: SoundPlayer): void {
    this.#flying.get(arrow.id)?.stop();
    if (landing.on === 'target') play('thud', landing.position);
    else if (landing.on === 'ground') play('earth', landing.position);
    else play('rattle', landing.position);
    // The chime is feedback for the archer: it sounds halfway to the head.
    if (landing.points > 0) play(chimeName(landing.points), lerp(landing.position, this.#head.position, 0.5), 0.12);
  }
}
