/** Events of one kind. Parts that are built early emit them; parts that are built later listen. */
export class Emitter<Event extends readonly unknown[] = []> {
  readonly #listeners: ((...event: Event) => void)[] = [];

  /** Bound, so that it can be handed out as a callback. */
  readonly emit = (...event: Event): void => {
    for (const listener of this.#listeners) listener(...event);
  };

  listen(listener: (...event: Event) => void): void {
    this.#listeners.push(listener);
  }
}
