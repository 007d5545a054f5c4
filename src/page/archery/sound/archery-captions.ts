import type { Pose } from 'threepoint/math';
import type { ArcheryEvent, BowCue, Landing, Target } from 'threepoint-games/archery';
import { directionText } from '../../scene/direction-text';

/** Targets have numbers, from the nearest. */
const targetName = (index: number): string => `target ${index + 1}`;

/** Which target a landing missed and on which side, as the archer at the origin sees it: "left of target 2". */
function missOf({ position }: Landing, targets: readonly Target[]): string | null {
  let nearest: { readonly index: number; readonly aside: number; readonly ahead: number; readonly off: number } | null =
    null;
  for (const [index, { centre }] of targets.entries()) {
    const along = Math.hypot(centre.x, centre.z);
    const ahead = (position.x * centre.x + position.z * centre.z) / along - along;
    const aside = (position.z * centre.x - position.x * centre.z) / along;
    const off = Math.hypot(aside, ahead);
    if (!nearest || off < nearest.off) nearest = { index, aside, ahead, off };
  }
  if (!nearest) return null;
  const { index, aside, ahead } = nearest;
  if (Math.abs(aside) > Math.abs(ahead)) return `${aside < 0 ? 'left' : 'right'} of ${targetName(index)}`;
  return `${ahead < 0 ? 'short of' : 'beyond'} ${targetName(index)}`;
}

function landingCaption(landing: Landing, targets: readonly Target[], head: Pose<'arena'>): string {
  if (landing.target !== null) {
    return landing.points > 0
      ? `Hit: ${targetName(landing.target)}, ${landing.points} points`
      : `Hit: ${targetName(landing.target)}, which had scored before`;
  }
  const where = landing.on === 'ground' ? 'Arrow in the grass' : 'Arrow in the net';
  const miss = landing.on === 'ground' ? missOf(landing, targets) : null;
  return `${where}, ${miss ?? directionText(head, landing.position)}`;
}

const endings = { targets: 'every target has scored', arrows: 'all arrows are shot', time: 'time is up' } as const;

/** Returns the caption of an event with its direction; the head in the arena frame. */
export function eventCaption(
  event: ArcheryEvent,
  { targets, seconds, head }: { targets: readonly Target[]; seconds: number; head: Pose<'arena'> },
): string {
  switch (event.type) {
    case 'started':
      return `The clock runs: ${seconds} seconds`;
    case 'released':
      return 'The string twangs, the arrow flies';
    case 'landed':
      return landingCaption(event.landing, targets, head);
    case 'left-zone':
      return `You left the deck: it is ${directionText(head, { x: 0, y: 0, z: 0 })}`;
    case 'entered-zone':
      return 'You are back on the deck';
    case 'ended':
      return `Bell: ${endings[event.end]}, ${event.score} points`;
  }
}

/** Returns the caption of a cue; null: the caption of an event covers it. */
export function cueCaption({ type, side }: BowCue): string | null {
  switch (type) {
    case 'taken':
      return `Bow in the ${side} hand`;
    case 'nocked':
      return 'Arrow nocked';
    case 'creak':
      return 'The bow creaks';
    case 'anchored':
      return 'Fully drawn';
    case 'cancelled':
      return 'Arrow back in the quiver';
    case 'too-soon':
      return 'You let go before the string was drawn: hold it longer';
    case 'lost':
      return `The ${side} hand is not tracked: the arrow waits`;
    case 'resumed':
      return `The ${side} hand is back`;
    case 'near-string':
    case 'released':
      return null;
  }
}
