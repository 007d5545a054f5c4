import type { BoneMap } from 'threepoint/core';
import * as v from 'valibot';
import { boneMap, type PreferenceStore } from '../session/preferences';

/** The number of files whose maps are stored, the newest ones. */
const maxFiles = 20;

/** The bone maps that users gave for files, by the files' SHA-256; on this device only. */
export class BoneMapStore {
  readonly #store: PreferenceStore;

  constructor(store: PreferenceStore) {
    this.#store = store;
  }

  /** The maps by the files' hashes. */
  get all(): Readonly<Record<string, BoneMap>> {
    return this.#store.preferences.bones ?? {};
  }

  of(hash: string): BoneMap | undefined {
    return this.all[hash];
  }

  /** A map that could not be read again is not kept: all that is remembered would be lost with it. */
  store(hash: string, bones: BoneMap): void {
    if (!v.is(boneMap, bones)) return;
    const kept = [...this.#without(hash), [hash, bones] as const].slice(-maxFiles);
    this.#store.remember({ bones: Object.fromEntries(kept) });
  }

  forget(hash: string): void {
    this.#store.remember({ bones: Object.fromEntries(this.#without(hash)) });
  }

  #without(hash: string): (readonly [string, BoneMap])[] {
    return Object.entries(this.all).filter(([each]) => each !== hash);
  }
}
