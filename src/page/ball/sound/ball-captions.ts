import type { Pose, Vec3 } from 'threepoint/math';
import type { BallCue, BallEvent, Refusal } from 'threepoint-games/ball';
import type { DisplayedPlayer } from '../../people/view/displayed-match';
import { markedName } from '../../people/view/displayed-match';
import { directionText } from '../../scene/direction-text';

/** The listener, and the positions of the other players. */
export interface Listener {
  /** Arena frame. */
  readonly head: Pose<'arena'>;
  /** Own player; null: a spectator. */
  readonly me: number | null;
  readonly people: readonly (DisplayedPlayer | null)[];
  /** Seconds of a match. */
  readonly seconds: number;
}

const playerName = ({ people, me }: Listener, player: number): string => {
  const person = people[player];
  return player === me ? 'You' : person ? markedName(person) : 'A player';
};

const refusals: Partial<Readonly<Record<Refusal, string>>> = {
  taken: 'Another player holds that ball',
  reach: 'Too far away',
  zone: 'Step back to your mark: only throws from there count',
  time: 'Too late: time is up',
  speed: 'That was faster than an arm can throw',
};

/** What an event sounds like, in words and, where it has a position, with its direction; null: nothing. */
export function eventCaption(event: BallEvent, at: Vec3 | null, listener: Listener): string | null {
  const where = at ? `, ${directionText(listener.head, at)}` : '';
  switch (event.type) {
    case 'started':
      return `Whistle: ${Math.round(listener.seconds)} seconds`;
    case 'thrown':
      return event.player === listener.me ? null : `${playerName(listener, event.player)} throws${where}`;
    case 'caught':
      return `Caught: ${event.score} ${event.score === 1 ? 'point' : 'points'}`;
    case 'bounced':
      return event.off === 'basket' ? `The ball hits the rim${where}` : null;
    case 'missed':
      return `The ball lands on the floor${where}`;
    case 'joined':
      return event.player === listener.me ? null : `${playerName(listener, event.player)} joins`;
    case 'left':
      return event.player === listener.me ? null : `${playerName(listener, event.player)} leaves`;
    case 'ended':
      return `Bell: ${event.end === 'time' ? 'time is up' : 'all balls are thrown'}, ${event.score} ${event.score === 1 ? 'point' : 'points'}`;
    case 'refused':
      return event.player === listener.me ? (refusals[event.reason] ?? null) : null;
    default:
      return null;
  }
}

/** Captions a cue of the user's hands; null: an event has a caption for it. */
export function cueCaption({ type, side }: BallCue): string | null {
  switch (type) {
    case 'grabbed':
      return `Ball in the ${side} hand`;
    case 'thrown':
      return 'You throw';
    case 'dropped':
      return 'Ball back in the rack';
    case 'slipped':
      return 'The ball slipped away';
    case 'near':
      return null;
  }
}
