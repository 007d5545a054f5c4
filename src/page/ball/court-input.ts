import type { BallSteering } from 'threepoint-games/ball/steered-players';
import type { ActivityContext } from '../activity/activity-context';

/** The source that moves the user's body at the court: a person in a headset, a mouse, or a simulated player. */
export class CourtInput {
  readonly #context: Pick<ActivityContext, 'place' | 'settings' | 'headset' | 'stage' | 'mouse'>;

  constructor(context: Pick<ActivityContext, 'place' | 'settings' | 'headset' | 'stage' | 'mouse'>) {
    this.#context = context;
  }

  /** No person wears the headset that moves the user's body. */
  get isSimulated(): boolean {
    const { place, settings, headset } = this.#context;
    return place === null && settings.actor && (!headset.worn || headset.emulator !== null);
  }

  /** A simulated player moves the user's body, not a mouse: no person can be asked. */
  get isActor(): boolean {
    return this.isSimulated && this.steering() === null;
  }

  /** Returns the mouse's target, floor frame of the user; null: the mouse does not play. */
  steering(): BallSteering | null {
    const { settings, headset, stage, mouse } = this.#context;
    if (!settings.mouse || headset.worn) return null;
    return { ray: stage.view.rayThrough(mouse.x, mouse.y), pressed: mouse.pressed, cancelled: mouse.cancelled };
  }
}
