import type { Buttons, HapticPulse, MutableHandShape, TrackingFrame } from 'threepoint/core';
import type { ObjectHolds } from 'threepoint/internal/three';
import type { Pose, Side } from 'threepoint/math';
import type { SimulatedInput } from 'threepoint-games';
import { type BallGame, defaultBallOptions } from 'threepoint-games/ball';
import type { ActivityContext } from '../activity/activity-context';
import { MatchActivity, type MatchOpening, openMatch } from '../people/match/match-activity';
import type { VoicesProbe } from '../people/voices/voices';
import { ballGame } from './ball-game';
import { BallView } from './ball-view';
import { courtScenes } from './court-camera';
import { graspAtCourt } from './court-grasp';
import { CourtInput } from './court-input';
import type { BallFrame } from './match/ball-frame';
import { BallPlay } from './match/ball-play';
import type { BallProbe } from './match/ball-probe';
import { eventHaptics } from './sound/ball-haptics';

/** The state of a match and of its voices, for tests and tools. */
export type BallActivityProbe = BallProbe & { readonly voices: VoicesProbe };

/** The ball game in the page. */
export class BallActivity extends MatchActivity<BallGame, BallFrame, BallPlay> {
  constructor(opening: MatchOpening<BallGame>) {
    const { context } = opening;
    const { quality, place, settings, layout, onCaption } = context;
    let play: BallPlay | null = null;
    const input = new CourtInput(context, () => play);
    super(opening, {
      game: ballGame,
      view: new BallView({ quality, balls: defaultBallOptions.balls, onCaption }),
      scenes: courtScenes,
      acting: () => input.isActor,
      createPlay(options) {
        play = new BallPlay({
          ...options,
          bots: () => settings.bots && place === null,
          steering: () => input.steering(),
          seed: layout.seed,
        });
        return play;
      },
    });
  }

  override act(time: number): SimulatedInput | null {
    return this.play.act(time, !this.context.headset.worn);
  }

  override update(frame: TrackingFrame, buttons: Buttons): readonly HapticPulse[] {
    const haptics = super.update(frame, buttons);
    const { me = null, role = null, events = [] } = this.play.newest ?? {};
    if (me === null || role === null || events.length === 0) return haptics;
    return [...haptics, ...eventHaptics(events, me, role)];
  }

  grasp(side: Side, wrist: Pose<'floor'>, holding: ObjectHolds, target: MutableHandShape): boolean {
    return graspAtCourt(this.play, side, wrist, holding, target);
  }

  override probe(): BallActivityProbe | null {
    const probe = this.play.probe();
    return probe && { ...probe, voices: this.voices.probe() };
  }
}

/** Enters the ball game. Rejects with a reason. */
export const openBallActivity = async (context: ActivityContext): Promise<BallActivity> =>
  new BallActivity(await openMatch(ballGame, context));
