import type { Activity } from '../activity/activity';
import type { BallActivity } from './ball-activity';

export const ball = {
  name: 'ball',
  title: 'Ball game',
  place: 'The ball court',
  floor: { halfWidth: 1.75, ahead: 5.6, behind: 0.5 },
  async load(context) {
    const { openBallActivity } = await import('./ball-activity');
    return openBallActivity(context);
  },
  async createRunner(services) {
    const [{ createMatchRunner }, { ballTask }] = await Promise.all([
      import('../people/match/match-runner'),
      import('./ball-task'),
    ]);
    return createMatchRunner(ballTask, services);
  },
} as const satisfies Activity<BallActivity>;
