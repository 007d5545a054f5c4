/** Returns whether touch is the primary input of this device, as on a phone. */
export const isTouchFirst = (): boolean => matchMedia('(pointer: coarse)').matches;

/**
 * The aim of a mouse, pen or finger: its position in the window, and whether it is pressed. Listens on the
 * canvas while enabled.
 */
export function createMouseAim(canvas: HTMLCanvasElement) {
  const aim = { x: 0, y: 0.1, pressed: false, cancelled: false };
  let enabled = false;
  const move = ({ clientX, clientY, isPrimary }: PointerEvent) => {
    if (!isPrimary) return;
    const { width, height } = canvas.getBoundingClientRect();
    aim.x = (2 * clientX) / width - 1;
    aim.y = 1 - (2 * clientY) / height;
  };
  canvas.addEventListener('pointermove', move);
  canvas.addEventListener('pointerdown', (event) => {
    if (!enabled) return;
    move(event);
    if (event.button !== 0 || !event.isPrimary) {
      aim.cancelled = true;
      return;
    }
    canvas.setPointerCapture(event.pointerId);
    aim.pressed = true;
    aim.cancelled = false;
  });
  for (const end of ['pointerup', 'pointercancel'] as const) {
    canvas.addEventListener(end, ({ button, isPrimary }) => {
      if (!isPrimary) return;
      if (end === 'pointercancel') aim.cancelled = true;
      if (button <= 0) aim.pressed = false;
    });
  }
  window.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape') return;
    aim.cancelled = true;
    // What else Esc would close stays open.
    if (enabled && aim.pressed) event.preventDefault();
  });
  canvas.addEventListener('contextmenu', (event) => {
    if (enabled) event.preventDefault();
  });
  return {
    /** From −1 to 1, right and up. */
    get x(): number {
      return aim.x;
    },
    get y(): number {
      return aim.y;
    },
    get pressed(): boolean {
      return enabled && aim.pressed;
    },
    /** Escape, the other button or a second finger, since the press began. */
    get cancelled(): boolean {
      return aim.cancelled;
    },
    setEnabled(on: boolean): void {
      enabled = on;
      if (!on) aim.pressed = false;
    },
  };
}

export type MouseAim = ReturnType<typeof createMouseAim>;
