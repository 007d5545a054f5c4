/** An event with its fields: `BodyEvent<'calibrated'>` has `calibration` and `source`. */
export type TypedEvent<Events, Name extends keyof Events> = Event & { readonly type: Name } & Events[Name];

type Listener<Events, Name extends keyof Events> = (event: TypedEvent<Events, Name>) => void;

/** An EventTarget whose events and fields the compiler knows. Exceptions of listeners are reported, not thrown. */
export interface TypedEventTarget<Events> {
  addEventListener<Name extends keyof Events>(
    type: Name,
    listener: Listener<Events, Name>,
    options?: AddEventListenerOptions,
  ): void;
  removeEventListener<Name extends keyof Events>(type: Name, listener: Listener<Events, Name>): void;
}

/** The class EventTarget, with typed listeners. */
export const TypedEvents = EventTarget as unknown as new <Events>() => TypedEventTarget<Events>;

/** Dispatches an event with these fields. Returns whether a listener has called its `preventDefault`. */
export function emit<Events, Name extends keyof Events & string>(
  target: TypedEventTarget<Events>,
  type: Name,
  fields: Events[Name],
): boolean {
  const event = Object.assign(new Event(type, { cancelable: true }), fields);
  // reason: the class behind the typed interface is EventTarget.
  return !(target as unknown as EventTarget).dispatchEvent(event);
}
