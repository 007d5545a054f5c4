import { render } from 'preact';
import { isTouchFirst } from 'threepoint-ui';
import { Button } from 'threepoint-ui/controls';
import './emulator-bar.css';

const actorText = 'The actor moves this body. Nobody is wearing a headset.';
const handsText = 'Drag the arrows at a hand to move it. Click them to turn it instead.';
const lookText =
  'The mouse looks, Left Shift with W, A, S or D walks, a click presses the right trigger, Esc frees the mouse.';

interface EmulatorBarActions {
  /** Lets the actor, or mouse and keys, move the emulated headset. */
  setActor(on: boolean): void;
  /** Lets the mouse turn the head, and keys walk, until Esc. */
  lookAround(): void;
}

/** Creates the bar of an emulated session: what moves the body, and how to do it by mouse and keys. */
export function createEmulatorBar(region: HTMLElement, actions: EmulatorBarActions) {
  let actor: boolean | null = null;
  function draw(): void {
    region.hidden = actor === null;
    const locked = document.pointerLockElement !== null;
    const isUsers = actor === false && !locked;
    render(
      <>
        <p role="status">{actor ? actorText : locked ? lookText : handsText}</p>
        <Button label="Take over" class="primary" hidden={!actor} onClick={() => actions.setActor(false)} />
        <Button label="Look and walk" hidden={!isUsers || isTouchFirst()} onClick={actions.lookAround} />
        <Button label="Let the actor move" hidden={!isUsers} onClick={() => actions.setActor(true)} />
      </>,
      region,
    );
  }
  document.addEventListener('pointerlockchange', draw);
  return {
    /** `state`: whether the actor moves the body; null: there is no emulated session. */
    show(state: boolean | null): void {
      actor = state;
      draw();
    },
  };
}
