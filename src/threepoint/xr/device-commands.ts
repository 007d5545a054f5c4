/** A stick pushed this far to the side turns, and may turn again once it is back below the second. */
const stickPushed = 0.7;
const stickBack = 0.35;

/** Indices of buttons in an “xr-standard” gamepad: the stick, and the upper face button (B or Y). */
const stickButton = 3;
const upperButton = 5;

/**
 * Indices of the buttons by which Quest's browser reports the menu pinch and the microgestures of a bare hand (WebXR
 * input profiles, `oculus-hand`).
 */
const handProfile = 'oculus-hand';
const handButtons = { menu: 4, swipeLeft: 5, swipeRight: 6, tapThumb: 9 } as const;

const isPressed = (gamepad: Gamepad | undefined, index: number): boolean => gamepad?.buttons[index]?.pressed ?? false;

/** Returns whether the browser reports the pinch of a bare hand as the device's menu button. */
export const isMenuPinch = ({ gamepad, profiles }: XRInputSource): boolean =>
  profiles.includes(handProfile) && isPressed(gamepad, handButtons.menu);

/** A button that acts once for each press. */
class Press {
  #down = false;
  #pressed = false;

  follow(down: boolean): void {
    if (down && !this.#down) this.#pressed = true;
    this.#down = down;
  }

  /** Ignores a press that lasts until it ends. */
  waitForRelease(): void {
    this.#down = true;
  }

  take(): boolean {
    const pressed = this.#pressed;
    this.#pressed = false;
    return pressed;
  }
}

/** Reads the commands of devices besides pointing: to turn the user, to mute the voice, to show the menu. */
export class DeviceCommands {
  /** Stick pressed down. */
  readonly mute = new Press();
  /** Upper face button; menu pinch or thumb tap of a bare hand. */
  readonly menu = new Press();
  #pushed = false;
  #turn: -1 | 0 | 1 = 0;

  watch(sources: XRInputSourceArray): void {
    let sideways = 0;
    let mute = false;
    let menu = false;
    for (const { gamepad, profiles } of sources) {
      if (profiles.includes(handProfile)) {
        menu ||= isPressed(gamepad, handButtons.menu) || isPressed(gamepad, handButtons.tapThumb);
        const swipe =
          Number(isPressed(gamepad, handButtons.swipeRight)) - Number(isPressed(gamepad, handButtons.swipeLeft));
        if (swipe !== 0) sideways = swipe;
        continue;
      }
      mute ||= isPressed(gamepad, stickButton);
      menu ||= isPressed(gamepad, upperButton);
      const pushed = gamepad?.axes[2] ?? 0;
      if (Math.abs(pushed) > Math.abs(sideways)) sideways = pushed;
    }
    this.mute.follow(mute);
    this.menu.follow(menu);
    if (Math.abs(sideways) < stickBack) this.#pushed = false;
    else if (Math.abs(sideways) > stickPushed && !this.#pushed) {
      this.#pushed = true;
      this.#turn = sideways > 0 ? -1 : 1;
    }
  }

  /** Ignores what is pushed or pressed now until it was released. */
  waitForRelease(): void {
    this.#pushed = true;
    this.mute.waitForRelease();
    this.menu.waitForRelease();
  }

  /** Requests a turn from elsewhere than a device; 1: to the left. */
  turn(direction: -1 | 1): void {
    this.#turn = direction;
  }

  /** Returns −1 or 1 once for each turn to the right or left; else 0. */
  takeTurn(): -1 | 0 | 1 {
    const turn = this.#turn;
    this.#turn = 0;
    return turn;
  }
}
