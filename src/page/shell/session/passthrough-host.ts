import { firstLine, reasonOf } from 'threepoint/core';
import type { PassthroughOptions, PassthroughRoom } from '../../passthrough/passthrough-room';
import type { Activities } from '../activities/activities';
import type { Headset } from '../headset';
import type { PreferenceStore } from '../preferences';
import type { Stage } from '../stage';

export interface PassthroughHostOptions extends Pick<PassthroughOptions, 'quality' | 'notices' | 'isCovered'> {
  readonly headset: Headset;
  readonly stage: Stage;
  readonly activities: Activities;
  readonly store: PreferenceStore;
}

/** Loads the user's own room for a session that shows it; other sessions and the desktop never load its code. */
export class PassthroughHost {
  readonly #options: PassthroughHostOptions;
  #room: PassthroughRoom | null = null;

  constructor(options: PassthroughHostOptions) {
    this.#options = options;
  }

  /** null: no session shows the room, or its code is still loading. */
  get room(): PassthroughRoom | null {
    return this.#room;
  }

  /** Call it when a session started or ended. Never rejects: a failure becomes a notice. */
  async sessionChanged(): Promise<void> {
    const { headset, notices } = this.#options;
    const session = headset.passthrough;
    this.#leave();
    if (!session) return;
    try {
      const { PassthroughRoom } = await import('../../passthrough/passthrough-room');
      if (headset.passthrough === session) this.#room = new PassthroughRoom(this.#roomOptions(session));
    } catch (error) {
      notices.show('error', `Your room could not be shown: ${firstLine(reasonOf(error))}. The usual world is shown.`);
    }
  }

  update(frame: XRFrame | undefined, time: number): void {
    if (frame) this.#room?.update(frame, time);
  }

  #leave(): void {
    if (!this.#room) return;
    this.#room.dispose();
    this.#room = null;
    this.#options.stage.placeMirror(this.#options.activities.current?.mirrorSide ?? null);
  }

  #roomOptions(session: XRSession): PassthroughOptions {
    const { headset, stage, activities, store } = this.#options;
    return {
      ...this.#options,
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
