import type { BodySolver } from 'threepoint/api/body-solver';
import { plainAvatar } from 'threepoint/core/body/avatar-ref';
import type { PageClock } from 'threepoint/core/tracking/page-clock';
import type { ServerPresence } from 'threepoint-http/server-presence';
import type { TaskPlace } from 'threepoint-study/participant/task-runner';
import type { MouseAim } from 'threepoint-ui/mouse-aim';
import type { Notices } from 'threepoint-ui/notices';
import type { ArcheryActivity } from '../archery/archery-activity';
import type { BallActivity } from '../ball/ball-activity';
import type { BallPlace } from '../ball/ball-connections';
import type { Quality } from '../scene/renderer';
import type { SurroundingsHost } from '../scene/surroundings';
import type { Headset } from './headset';
import type { Settings } from './settings';
import { fetchOwnAvatar, type ShownAvatar } from './shown-avatar';
import type { Stage } from './stage';
import type { Switches } from './switches';

type Connections = typeof import('../ball/ball-connections');

export interface GamesOptions {
  readonly quality: Quality;
  readonly switches: Switches;
  readonly settings: Settings;
  readonly clock: PageClock;
  readonly stage: { readonly studio: SurroundingsHost; readonly view: Pick<Stage['view'], 'rayThrough'> };
  readonly mouse: MouseAim;
  readonly headset: Pick<Headset, 'worn' | 'emulator'>;
  readonly body: Pick<BodySolver, 'calibration'>;
  readonly avatar: Pick<ShownAvatar, 'own' | 'worn'>;
  readonly server: Pick<ServerPresence, 'known'>;
  readonly notices: Pick<Notices, 'show'>;
  onCaption(text: string): void;
}

/** What a game is opened with. */
export interface Opening {
  /** Of the next round's or match's layout. */
  seed(): number;
  /** Where a study plays the ball game; null: where the address says. */
  readonly place: TaskPlace | null;
}

/** Opens the games of this page, whose code is loaded when they are first played. Rejects where one cannot be opened. */
export interface Games {
  archery(opening: Pick<Opening, 'seed'>): Promise<ArcheryActivity>;
  ball(opening: Opening): Promise<BallActivity>;
}

export class PageGames implements Games {
  readonly #options: GamesOptions;

  constructor(options: GamesOptions) {
    this.#options = options;
  }

  async archery({ seed }: Pick<Opening, 'seed'>): Promise<ArcheryActivity> {
    const { quality, settings, stage, body, onCaption } = this.#options;
    const { createArcheryActivity } = await import('../archery/archery-activity');
    return createArcheryActivity({
      quality,
      surroundings: stage.studio,
      calibration: body.calibration,
      settings: () => settings,
      seed,
      onCaption,
    });
  }

  async ball({ seed, place }: Opening): Promise<BallActivity> {
    const { quality, settings, switches, stage, mouse, headset, body, avatar, notices, onCaption } = this.#options;
    const [{ createBallActivity }, connections, mannequin] = await Promise.all([
      import('../ball/ball-activity'),
      import('../ball/ball-connections'),
      fetchOwnAvatar(plainAvatar),
    ]);
    return createBallActivity({
      quality,
      surroundings: stage.studio,
      mannequin,
      fetchOwn: (name) => fetchOwnAvatar(name),
      ...(await this.#place(connections, seed(), place)),
      relayOnly: () => settings.voicesByRelay,
      worn: () => (settings.shareAvatar || avatar.own ? avatar.worn : null),
      plainOthers: () => settings.plainOthers,
      notify: (level, text) => notices.show(level, text),
      visitor: {
        name: place?.participant || settings.name || settings.guestName,
        calibration: body.calibration,
        ...(place && { seat: place.members.indexOf(place.participant) }),
        ...(switches.spectate && { spectate: true }),
      },
      unnamed: !place && !settings.name,
      bots: () => settings.bots && place === null,
      acting: () => place === null && settings.actor && (!headset.worn || headset.emulator !== null),
      steering: () =>
        settings.mouse && !headset.worn
          ? { ray: stage.view.rayThrough(mouse.x, mouse.y), pressed: mouse.pressed, cancelled: mouse.cancelled }
          : null,
      seed: seed(),
      onCaption,
    });
  }

  async #place(connections: Connections, seed: number, place: TaskPlace | null): Promise<BallPlace> {
    const { switches, clock, server } = this.#options;
    if (place) return connections.assignedSeat(place.seat, clock);
    // A server that is silent is waited for; where there is none, the match is in this page.
    const hosted = switches.room !== null && (await server.known()) !== 'none';
    return connections.connectionsFor(hosted ? switches.room : null, {
      seed,
      clock,
      ...(switches.seconds && { seconds: switches.seconds }),
      ...(switches.balls && { balls: switches.balls }),
    });
  }
}
