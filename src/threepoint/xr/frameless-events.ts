const inputEvents = ['select', 'selectstart', 'selectend', 'squeeze', 'squeezestart', 'squeezeend'];

/**
 * Some runtimes tell of a button without the frame that it was pressed in (`frame: null`), which three's controllers do not survive. Such
 * an event is held back and told again, in the next frame and with it. Call it before anything else listens to the session.
 */
export function giveFramesToEvents(session: XRSession): void {
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
