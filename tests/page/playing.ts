import { defaultCalibration } from 'threepoint/core';
import { ArcheryPlay } from '../../src/page/archery/archery-play';
import { BallPlay, type BallPlayOptions } from '../../src/page/ball/match/ball-play';
import { visitor } from '../rooms/client/people';

type BallPageOptions = Partial<Pick<BallPlayOptions, 'bots' | 'readyByItself' | 'steering' | 'seed'>> & {
  readonly name?: string;
  /** The seat that the page asks for; undefined: any. */
  readonly seat?: number | undefined;
  readonly spectate?: boolean | undefined;
};

/** Returns the ball game of Robin's page in a room without bots; unless these say otherwise, a person presses Ready. */
export function ballPage(
  room: { connect: BallPlayOptions['connect'] },
  { name = 'Robin', seat, spectate, ...options }: BallPageOptions = {},
): BallPlay {
  return new BallPlay({
    connect: (joining, time) => room.connect(joining, time),
    visitor: visitor(name, { ...(seat !== undefined && { seat }), ...(spectate && { spectate }) }),
    bots: () => false,
    readyByItself: () => false,
    seed: 1,
    ...options,
  });
}

type ArcherySettings = ReturnType<ConstructorParameters<typeof ArcheryPlay>[1]>;

/** Returns a page's archery with the bow in the left hand; unless these say otherwise, by the rules alone. */
export const archeryPage = (settings: Partial<ArcherySettings> = {}, seed = () => 7) =>
  new ArcheryPlay(
    defaultCalibration,
    () => ({ bowSide: 'left', oneHanded: false, everyHitCounts: false, ...settings }),
    seed,
  );
