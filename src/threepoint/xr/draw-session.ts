import type { DrawingSpace } from './tracked-session';

/** The part of a renderer that draws a session: `renderer.xr` of three.js. */
interface SessionDrawing extends DrawingSpace {
  setSession(session: XRSession): Promise<void>;
}

/** Ends a session; has no effect on one that has ended. */
export async function endSession(session: XRSession): Promise<void> {
  // reason: only a session that has ended already, or is about to, refuses to end
  await session.end().catch(() => undefined);
}

/**
 * Lets a renderer draw a session that was just requested. `prepare` runs once it is drawn; its result is returned.
 * Rejects with a sentence, and ends the session, where that fails, where the device provides no floor, or where the
 * session ends meanwhile.
 */
export async function drawSession<Prepared>(
  session: XRSession,
  drawing: SessionDrawing,
  prepare: () => Prepared | Promise<Prepared>,
): Promise<Prepared> {
  const over = new Promise<never>((_, reject) => {
    session.addEventListener('end', () => reject(new Error('the session ended before it had begun')), { once: true });
  });
  const draw = async (): Promise<Prepared> => {
    addFramesToEvents(session);
    await drawing.setSession(session);
    if (!drawing.getReferenceSpace())
      throw new Error('the headset provides no floor-level reference space (local-floor)');
    return prepare();
  };
  try {
    return await Promise.race([draw(), over]);
  } catch (error) {
    // A session that is not drawn would keep the headset waiting, and no other could start.
    await endSession(session);
    throw error;
  }
}

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
