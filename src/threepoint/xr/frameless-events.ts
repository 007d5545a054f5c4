const inputEvents = ['select', 'selectstart', 'selectend', 'squeeze', 'squeezestart', 'squeezeend'];

/**
 * Adds frames to input events that a runtime fires without one (`frame: null`), which crash three's controllers. Such
 * an event is stopped and fired again with the next frame. Call it before other listeners are added to the session.
 */
export function addFramesToEvents(session: XRSession): void {
  for (const type of inputEvents) {
    session.addEventListener(type, (event) => {
      const { frame, inputSource } = event as XRInputSourceEvent;
      if (frame) return;
      event.stopImmediatePropagation();
      session.requestAnimationFrame((_, next) => {
        const again = Object.defineProperties(new Event(type), {
          frame: { value: next },
          inputSource: { value: inputSource },
        });
        if (next) session.dispatchEvent(again);
      });
    });
  }
}
