import { firstLine, reasonOf } from 'threepoint/core';
import type { PassthroughOptions, PassthroughRoom } from '../../passthrough/passthrough-room';
import type { StageParts } from './stage-parts';

/** Loads the user's own room for a session that shows it; other sessions and the desktop never load its code. */
export class PassthroughHost {
  readonly #parts: StageParts;
  readonly #isCovered: () => boolean;
  #room: PassthroughRoom | null = null;

  /** `isCovered`: whether the mirror is behind something that a hand points at. */
  constructor(parts: StageParts, isCovered: () => boolean) {
    this.#parts = parts;
    this.#isCovered = isCovered;
  }

  /** null: no session shows the room, or its code is still loading. */
  get room(): PassthroughRoom | null {
    return this.#room;
  }

  /** Call it when a session started or ended. Never rejects: a failure becomes a notice. */
  async sessionChanged(): Promise<void> {
    const { headset, notices } = this.#parts;
    const session = headset.passthrough;
    this.#leave();
    notices.withdraw('passthrough');
    if (!session) return;
    try {
      const { PassthroughRoom } = await import('../../passthrough/passthrough-room');
      if (headset.passthrough === session) this.#room = new PassthroughRoom(this.#roomOptions(session));
    } catch (error) {
      notices.show(
        'error',
        `Your room could not be shown: ${firstLine(reasonOf(error))}. The usual world is shown.`,
        'passthrough',
      );
    }
  }

  update(frame: XRFrame | undefined, time: number): void {
    if (frame) this.#room?.update(frame, time);
  }

  #leave(): void {
    if (!this.#room) return;
    this.#room.dispose();
    this.#room = null;
    this.#parts.stage.placeMirror(this.#parts.activities.current?.mirrorSide ?? null);
  }

  #roomOptions(session: XRSession): PassthroughOptions {
    const { headset, stage, activities, store, notices } = this.#parts;
    return {
      notices,
      isCovered: this.#isCovered,
      session,
      room: headset.room,
      studio: stage.studio,
      standMirror: (x, floor, z, turned) => stage.standMirror(x, floor, z, turned),
      floorSpace: () => headset.tracking?.floorSpace ?? null,
      activity: () => (activities.current && activities.all.find(({ name }) => name === activities.name)) ?? null,
      kept: {
        get handle() {
          return store.preferences.mirrorAnchor;
        },
        store: (mirrorAnchor) => store.remember({ mirrorAnchor }),
      },
    };
  }
}
