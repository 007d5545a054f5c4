import {
  add,
  clamp,
  invertTransform,
  length,
  lerp,
  type Pose,
  type Transform,
  transformPoint,
  transformPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import {
  type BallCue,
  type BallEvent,
  type BallState,
  ballInAir,
  ballSecondsLeft,
  holderStation,
  stations,
  type TimedLaunch,
} from 'threepoint-games/ball';
import type { DisplayedPlayer } from '../../people/view/displayed-match';
import { createSoundStage, type Recipe, type Recipes, type SoundPlayer } from '../../scene/sound/sound-stage';
import { bell, chime, click, warning, whoosh } from '../../scene/sound/sound-synthesis';
import type { Palms } from '../match/ball-frame';
import { cueCaption, eventCaption, type Listener } from './ball-captions';
import { bounce, caughtInWicker, knock, tick, whistle } from './ball-synthesis';

/** One frame of a match for the ears. */
interface SoundFrame {
  readonly state: BallState;
  readonly events: readonly BallEvent[];
  readonly cues: readonly BallCue[];
  readonly me: number | null;
  readonly people: readonly (DisplayedPlayer | null)[];
  /** The position of a ball in each of the user's hands, arena frame; null: the hand is not tracked. */
  readonly palms: Palms;
}

const bounceSteps = 4;
const bounceName = (strength: number): string => `bounce ${Math.round(clamp(strength, 0, 1) * bounceSteps)}`;
/** Four notes, over and over: each catch sounds higher than the one before, until the next four. */
const chimeName = (score: number): string => `chime ${5 * (((score - 1) % 4) + 1)}`;

const recipes: Recipes = new Map<string, Recipe>([
  ...Object.entries({ bell, click, knock, tick, warning, whistle, whoosh, wicker: caughtInWicker }),
  ...Array.from({ length: bounceSteps + 1 }, (_, step): [string, Recipe] => [
    bounceName(step / bounceSteps),
    (rate) => bounce(rate, step / bounceSteps),
  ]),
  ...[5, 10, 15, 20].map((points): [string, Recipe] => [`chime ${points}`, (rate) => chime(rate, points)]),
]);

const boardAt = vec3(0, 3, -6);
const headOfStation = (station: number): Vec3 => add((stations[station] ?? stations[0]!).position, vec3(0, 1.4, 0));

/** Returns the position of an event's sound, arena frame; null: it has no position. */
function soundPosition(event: BallEvent, state: BallState): Vec3 | null {
  switch (event.type) {
    case 'thrown':
    case 'bounced':
    case 'rolls':
      return event.launch.position;
    case 'missed': {
      const location = state.balls[event.ball];
      return location?.on === 'air' || location?.on === 'floor' ? location.launch.position : null;
    }
    case 'caught':
      return headOfStation(holderStation);
    case 'grabbed':
    case 'returned':
    case 'joined':
    case 'left':
      return headOfStation(state.players[event.player]?.station ?? 0);
    default:
      return null;
  }
}

/** Plays the sounds of the ball game from where they happen, with captions. */
export class BallSounds {
  readonly #onCaption: (text: string) => void;
  /** The stage that plays the sounds. It must be unlocked; captions work without it. */
  readonly stage = createSoundStage(recipes);
  #floorFromArena: Transform<'floor', 'arena'> = {
    position: vec3(0, 0, 0),
    orientation: { x: 0, y: 0, z: 0, w: 1 },
  };
  #head: Pose<'floor'> = { position: vec3(0, 1.6, 0), orientation: { x: 0, y: 0, z: 0, w: 1 } };
  /** The second before the bell that ticked last; 0: none did. */
  #ticked = 0;

  constructor(onCaption: (text: string) => void) {
    this.#onCaption = onCaption;
  }

  playEvents(played: SoundFrame): void {
    const playing = this.stage.player;
    const { state, events, cues, people, me, palms } = played;
    const head = transformPose(invertTransform(this.#floorFromArena), this.#head);
    const listener: Listener = { head, me, people, seconds: state.options.seconds };
    for (const cue of cues) {
      this.#caption(cueCaption(cue));
      if (playing) this.#playCue(cue, palms, playing);
    }
    for (const event of events) {
      this.#caption(eventCaption(event, soundPosition(event, state), listener));
      if (playing) this.#playEvent(event, played, playing);
    }
    this.#tick(state, playing);
  }

  /** Sets the pose of the listener's head, floor frame. */
  setListener(head: Pose<'floor'>, floorFromArena: Transform<'floor', 'arena'>): void {
    this.#head = head;
    this.#floorFromArena = floorFromArena;
    this.stage.setListener(head);
  }

  dispose(): void {
    this.stage.dispose();
  }

  #inFloor(point: Vec3): Vec3 {
    return transformPoint(this.#floorFromArena, point);
  }

  #caption(text: string | null): void {
    if (text) this.#onCaption(text);
  }

  /** The last ten seconds tick. */
  #tick(state: BallState, playing: SoundPlayer | null): void {
    const left = state.phase === 'running' ? Math.ceil(ballSecondsLeft(state)) : 0;
    if (playing && left > 0 && left <= 10 && left !== this.#ticked) playing.play('tick', this.#inFloor(boardAt));
    this.#ticked = left;
  }

  #playCue({ type, side }: BallCue, palms: SoundFrame['palms'], { play }: SoundPlayer): void {
    const at = palms[side];
    if (!at) return;
    if (type === 'grabbed' || type === 'dropped') play('click', this.#inFloor(at));
    else if (type === 'slipped') play('warning', this.#inFloor(at));
  }

  #playEvent(event: BallEvent, { state, me }: SoundFrame, playing: SoundPlayer): void {
    const { play } = playing;
    const at = soundPosition(event, state);
    switch (event.type) {
      case 'started':
        play('whistle', this.#inFloor(boardAt));
        return;
      case 'ended':
        play('bell', this.#inFloor(boardAt), 0.2);
        return;
      case 'thrown':
        this.#playFlight(event.launch, playing);
        return;
      case 'caught':
        if (at) play('wicker', this.#inFloor(at));
        // The chime is feedback for all players: it sounds halfway to the head.
        if (at) play(chimeName(event.score), lerp(this.#inFloor(at), this.#head.position, 0.5), 0.1);
        return;
      case 'bounced': {
        const name = event.off === 'basket' ? 'knock' : bounceName(length(event.launch.velocity) / 6);
        if (at) play(name, this.#inFloor(at));
        return;
      }
      case 'grabbed':
        if (at && event.player !== me) play('click', this.#inFloor(at));
        return;
      case 'refused':
        if (event.player === me && event.reason !== 'seen-before') play('warning', this.#head.position);
    }
  }

  /** Plays a whoosh that moves with the ball. */
  #playFlight(launch: TimedLaunch, { playAlong }: SoundPlayer): void {
    playAlong('whoosh', 0.6, (after) => this.#inFloor(ballInAir(launch, launch.time + after)));
  }
}
