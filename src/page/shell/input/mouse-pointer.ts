import { MutablePointer, type Pointer } from 'threepoint/core';
import type { MouseAim } from 'threepoint-ui';
import type { DesktopView } from '../../scene/desktop-view';
import type { StageParts } from '../stage/stage-parts';

/** Returns the mouse, pen or finger in the window as a pointer into the scene, as of now. */
export function createMousePointer(mouse: MouseAim, view: DesktopView): () => Pointer {
  const pointer = new MutablePointer('mouse');
  return () => {
    const { origin, direction } = view.rayThrough(mouse.x, mouse.y);
    pointer.begin();
    pointer.setRay(origin, direction);
    pointer.held = mouse.pressed;
    pointer.cancelled = mouse.cancelled;
    return pointer;
  };
}

/** The mouse presses what the sheets of a game offer. A study's participant plays with the headset alone. */
export function pressSheetsByMouse({ stage, headset, study, activities }: StageParts): void {
  const { view } = stage;
  const canvas = stage.renderer.domElement;

  /** Whether the mouse is on a button of a sheet. */
  function pointAt({ clientX, clientY }: MouseEvent, press: boolean): boolean {
    if (headset.worn || study.run) return false;
    const { width, height } = canvas.getBoundingClientRect();
    const ray = view.rayThrough((2 * clientX) / width - 1, 1 - (2 * clientY) / height);
    return Boolean(activities.current?.point?.(ray, press));
  }

  /** Whether the mouse button went down on a sheet: a sheet that came under a throw is not meant. */
  let pressing = false;
  canvas.addEventListener('pointerdown', (event) => {
    pressing = pointAt(event, false);
  });
  canvas.addEventListener('click', (event) => {
    if (pressing) pointAt(event, true);
  });
}
