import type { Activity } from '../activity/activity';
import type { ArcheryActivity } from './archery-activity';

export const archery = {
  name: 'archery',
  title: 'Archery',
  place: 'The archery range',
  floor: { halfWidth: 2.5, ahead: 11, behind: 0.5 },
  async load(context) {
    const { createArcheryActivity } = await import('./archery-activity');
    return createArcheryActivity(context);
  },
  async createRunner(services) {
    const { createArcheryRunner } = await import('./archery-runner');
    return createArcheryRunner(services);
  },
} as const satisfies Activity<ArcheryActivity>;
