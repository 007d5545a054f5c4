import { render } from 'preact';
import { isTouchFirst } from 'threepoint-ui';
import { Button } from 'threepoint-ui/controls';
import './emulator-bar.css';

const actorText = 'The actor moves this body. Nobody is wearing a headset.';
const handsText = 'Drag the arrows at a hand to move it. Click them to turn it instead.';
const lookText =
  'The mouse looks, Left Shift with W, A, S or D walks, a click presses the right trigger, Esc frees the mouse.';

interface EmulatorBarActions {
  /** Lets the actor, or mouse and keys, move the emulated headset; absent: there is no actor. */
  setActor?(on: boolean): void;
  /** Lets the mouse turn the head, and keys walk, until Esc. */
  lookAround(): void;
  /** Ends the session; absent: another part of the page does. */
  stop?(): void;
}

interface EmulatorBarState {
  /** Whether the actor moves the body. */
  readonly actor: boolean;
  /** What the user is asked to do; absent: nothing. */
  readonly task?: string;
}

/** Creates the bar of an emulated session: what moves the body, and how to do it by mouse and keys. */
export function createEmulatorBar(region: HTMLElement, { setActor, lookAround, stop }: EmulatorBarActions) {
  let shown: EmulatorBarState | null = null;
  function draw(): void {
    region.hidden = shown === null;
    const locked = document.pointerLockElement !== null;
    const isUsers = shown?.actor === false && !locked;
    render(
      <>
        <div>
          <p hidden={!shown?.task}>
            <b>{shown?.task}</b>
          </p>
          <p role="status">{shown?.actor ? actorText : locked ? lookText : handsText}</p>
        </div>
        <Button label="Take over" class="primary" hidden={!shown?.actor} onClick={() => setActor?.(false)} />
        <Button label="Look and walk" hidden={!isUsers || isTouchFirst()} onClick={lookAround} />
        {setActor && <Button label="Let the actor move" hidden={!isUsers} onClick={() => setActor(true)} />}
        {stop && <Button label="Stop" onClick={stop} />}
      </>,
      region,
    );
  }
  document.addEventListener('pointerlockchange', draw);
  return {
    /** null: there is no emulated session. */
    show(state: EmulatorBarState | null): void {
      shown = state;
      draw();
    },
  };
}
