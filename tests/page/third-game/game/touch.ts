import type { Activity } from '../../../../src/page/activity/activity';
import type { TouchActivity } from './touch-activity';

/** “Touch the lit targets” for two. */
export const touch = {
  name: 'touch',
  title: 'Touch',
  place: 'The targets',
  load: async (context) => (await import('./touch-activity')).openTouch(context),
  async createRunner(services) {
    const [{ createMatchRunner }, { touchTask }] = await Promise.all([
      import('../../../../src/page/people/match/match-runner'),
      import('./touch-activity'),
    ]);
    return createMatchRunner(touchTask, services);
  },
} as const satisfies Activity<TouchActivity>;
