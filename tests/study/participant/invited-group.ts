import type { SignedSeat } from 'threepoint-study';
import { createExperimenterClient, createParticipantClient } from '../../../src/study/client/study-client';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { forkServer } from '../../server/server-child';
import { experimenterToken } from '../../server/started-server';
import { paperPlan } from '../model/studies';

/** Serves the paper's study. Returns its first group of three, and what signs a participant's seat in a ball trial. */
export async function invitedGroup() {
  const { url: origin } = await forkServer();
  const experimenter = createExperimenterClient(experimenterToken, origin);
  await experimenter.addStudy(paperPlan(), false);
  const states = await experimenter.participants('paper');
  const group = scheduleFor(paperPlan(), 'P01').groups.ball?.members as readonly string[];
  const client = createParticipantClient(origin);
  const seatOf = async (participant: string): Promise<() => Promise<SignedSeat>> => {
    const invitation = states.find((state) => state.participant === participant)?.invitation as string;
    const { token } = await client.claim({ study: 'paper', participant }, invitation, paperPlan().consent.version);
    return () => client.seat({ study: 'paper', participant, token }, { step: 'ball/1/trial-1', run: 1 });
  };
  return { origin, group, seatOf };
}
