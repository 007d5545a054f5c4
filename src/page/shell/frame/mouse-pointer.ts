import { MutablePointer, type Pointer } from 'threepoint/core/input/pointer';
import type { MouseAim } from 'threepoint-ui/mouse-aim';
import type { DesktopView } from '../../scene/desktop-view';

/** Returns the mouse, pen or finger in the window as a pointer into the scene, as of now. */
export function createMousePointer(mouse: MouseAim, view: Pick<DesktopView, 'rayThrough'>): () => Pointer {
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
