import type { Activity } from '../activity/activity';
import { archery } from '../archery/archery';
import { ball } from '../ball/ball';

/** The activities of this page, in the order of their buttons. The rest of the shell knows them only as activities. */
export const activities = [archery, ball] as const satisfies readonly Activity[];

/** The name of the mirror, where the user is while in no activity. */
export const home = 'studio';

/** The values of `play=` in the address. */
export const placeNames = [home, ...activities.map(({ name }) => name)] as const;

type Opened = Awaited<ReturnType<(typeof activities)[number]['load']>>;

/** The states of the games, for tests and tools. */
export type GameProbe = NonNullable<ReturnType<Opened['probe']>>;
