import { createHmac, randomBytes } from 'node:crypto';
import { ballKind } from '../src/core/protocol/ball-messages';
import type { StudyPlan } from '../src/core/study/plan';
import { scheduleFor } from '../src/core/study/schedule';
import type { PlayedTogether, SignedSeat } from '../src/core/study/study-api';
import { ValidationError } from '../src/core/study/validation';
import type { RoomTokens } from './room-tokens';

/** Signs participants, and them alone, into the rooms of their trials. */
export interface StudySeats {
  /** The participant's own seat, or a place among those who watch; throws a ValidationError where the step is not played together. */
  sign(plan: StudyPlan, participant: string, trial: PlayedTogether, watching: boolean): Promise<SignedSeat>;
}

/** `secret`: names rooms, so that no one can know the name of one beforehand; the same in every process of a fleet. */
export function createStudySeats(secret: string, tokens: Pick<RoomTokens, 'sign'>): StudySeats {
  const nameOf = (purpose: string, ...parts: readonly unknown[]): string =>
    createHmac('sha256', secret)
      .update(JSON.stringify([purpose, ...parts]))
      .digest('hex')
      .slice(0, 24);

  return {
    async sign(plan, participant, { step: id, run }, watching) {
      const schedule = scheduleFor(plan, participant);
      const step = schedule.steps.find((candidate) => candidate.id === id);
      const played = step && (step.kind === 'trial' || step.kind === 'tutorial') ? step : null;
      const task = plan.tasks.find((candidate) => candidate.id === played?.task);
      if (!played || task?.game !== 'ball') {
        throw new ValidationError('step', `expected a step that ${participant} plays with others, not "${id}"`);
      }
      const group = schedule.groups[played.task];
      const room = `study.${nameOf('room of a study', plan.id, id, run, group?.number)}`;
      const token = await tokens.sign({
        // The same person on every device and after every reload: the seat is theirs.
        identity: watching ? randomBytes(12).toString('base64url') : nameOf('participant', plan.id, participant),
        room,
        kind: ballKind,
        terms: { seconds: played.seconds, pausable: true },
        assigned: watching
          ? { seat: null, name: 'Experimenter' }
          : { seat: group?.members.indexOf(participant) ?? null, name: participant },
      });
      return { room, token };
    },
  };
}
