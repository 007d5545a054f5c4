import type { Activity } from '../activity/activity';
import type { BallActivity } from '../people/match/match-activity';

export const ball = {
  name: 'ball',
  title: 'Ball game',
  place: 'The ball court',
  floor: { halfWidth: 1.75, ahead: 5.6, behind: 0.5 },
  async load(context) {
    const { openBallActivity } = await import('../people/match/match-activity');
    return openBallActivity(context);
  },
  async createRunner(services) {
    const { createBallRunner } = await import('../people/match/match-runner');
    return createBallRunner(services);
  },
} as const satisfies Activity<BallActivity>;
