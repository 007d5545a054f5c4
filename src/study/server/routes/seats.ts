import { createHmac, randomBytes } from 'node:crypto';
import { ValidationError } from 'threepoint/core';
import { games } from 'threepoint-games/all';
import { absenceRuleOf, type StudyPlan } from '../../model/plan/plan';
import { isPlayed, scheduleFor } from '../../model/plan/schedule';
import type { PlayedTogether, SignedSeat } from '../../model/progress/study-api';

/** The claims of a participant's place in a room, which the server's rooms read from a signed token. */
export interface SeatClaim {
  /** Identifies the participant, the same on every device; others cannot derive it. */
  readonly identity: string;
  readonly room: string;
  /** The game of the room. */
  readonly kind: string;
  /** The length of the match, and for how long it waits for a participant who is away [s]. */
  readonly terms: { readonly seconds: number; readonly waitSeconds: number };
  /** `seat` null: a place among the spectators. */
  readonly assigned: { readonly seat: number | null; readonly name: string };
}

/** Returns the claim as signed text that the server's rooms accept. */
export type SignSeat = (claim: SeatClaim) => Promise<string>;

export type StudySeats = ReturnType<typeof createStudySeats>;

/**
 * Returns what signs participants into the rooms of their trials. `secret` makes the names of rooms unguessable; all
 * processes of a fleet have the same one.
 */
export function createStudySeats(secret: string, signSeat: SignSeat) {
  const nameOf = (purpose: string, ...parts: readonly unknown[]): string =>
    createHmac('sha256', secret)
      .update(JSON.stringify([purpose, ...parts]))
      .digest('hex')
      .slice(0, 24);

  return {
    /**
     * Resolves with the participant's seat, or with a spectator's place; throws a ValidationError if the step is not
     * played together.
     */
    async sign(plan: StudyPlan, participant: string, trial: PlayedTogether, watching: boolean): Promise<SignedSeat> {
      const { step: id, run } = trial;
      const schedule = scheduleFor(plan, participant);
      const step = schedule.steps.find((candidate) => candidate.id === id);
      const played = step && isPlayed(step) ? step : null;
      const task = plan.tasks.find((candidate) => candidate.id === played?.task);
      if (!played || !task || games[task.game].players === 1) {
        throw new ValidationError('step', `expected a step that ${participant} plays with others, not "${id}"`);
      }
      const group = schedule.groups[played.task];
      const room = `study.${nameOf('room of a study', plan.id, id, run, group?.number)}`;
      const token = await signSeat({
        // The identity is the same on every device and after every reload, so that the seat is kept.
        identity: watching ? randomBytes(12).toString('base64url') : nameOf('participant', plan.id, participant),
        room,
        kind: task.game,
        terms: { seconds: played.seconds, waitSeconds: absenceRuleOf(task).waitSeconds },
        assigned: watching
          ? { seat: null, name: 'Experimenter' }
          : { seat: group?.members.indexOf(participant) ?? null, name: participant },
      });
      return { room, token };
    },
  };
}
