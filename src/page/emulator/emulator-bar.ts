import { button, element, isTouchFirst } from 'threepoint-ui';
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
  const text = element('p', { role: 'status' });
  const takeOver = button('Take over', () => actions.setActor(false), { class: 'primary' });
  const look = button('Look and walk', () => actions.lookAround());
  const back = button('Let the actor move', () => actions.setActor(true));
  region.append(text, takeOver, look, back);
  let actor = true;
  function show(): void {
    const locked = document.pointerLockElement !== null;
    text.textContent = actor ? actorText : locked ? lookText : handsText;
    takeOver.hidden = !actor;
    look.hidden = actor || locked || isTouchFirst();
    back.hidden = actor || locked;
  }
  document.addEventListener('pointerlockchange', show);
  return {
    /** `actor`: the actor moves the body; null: there is no emulated session. */
    show(state: boolean | null): void {
      region.hidden = state === null;
      actor = state ?? true;
      show();
    },
  };
}
