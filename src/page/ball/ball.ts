import type { Activity } from '../activity/activity';
import type { CourtActivity } from './court-activity';

export const ball = {
  name: 'ball',
  title: 'Ball game',
  place: 'The ball court',
  floor: { halfWidth: 1.75, ahead: 5.6, behind: 0.5 },
  async load(context) {
    const { openCourt } = await import('./court-activity');
    return openCourt(context);
  },
  async createRunner(host) {
    const { createBallRunner } = await import('./ball-runner');
    return createBallRunner(host);
  },
} as const satisfies Activity<CourtActivity>;
