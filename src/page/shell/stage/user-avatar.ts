import {
  type BoneMap,
  type BuiltInBody,
  bodyOf,
  defaultAvatar,
  firstLine,
  reasonOf,
  skinToneOf,
  UnknownBonesError,
} from 'threepoint/core';
import { type CheckedAvatar, MotionOnlyError } from 'threepoint/files';
import { bodyLabelOf, weaveCloth } from 'threepoint/internal/three';
import type { Avatar } from 'threepoint/three';
import type { OwnAvatar } from 'threepoint-rooms/internal';
import { fileNameOf } from 'threepoint-ui';
import type { SkeletonToMap } from '../../bones/skeleton-to-map';
import type { SessionParts } from '../session/session-parts';
import { ownColours } from '../session/settings';
import { type AvatarLoader, fetchBuiltInAvatar, type UserAvatarState } from './avatar-loader';

/** An avatar that was requested, until it is shown, refused or cancelled. */
interface Request {
  readonly turn: number;
  readonly name: string;
  readonly isBuiltIn: boolean;
  readonly cancellation: AbortController;
  /** The checked file; null: not loaded yet, or a built-in avatar. */
  checked: CheckedAvatar | null;
}

/** A file that the user opened as an avatar. */
export type OwnFile = Pick<CheckedAvatar, 'name' | 'file'>;

/** Returns the reason of a failure without the name of its file. */
const reasonFor = (name: string, error: unknown): string => firstLine(reasonOf(error)).replace(`${name}: `, '');

/** The avatar on the stage. Another one replaces it only when it has been loaded completely. */
export class UserAvatar {
  readonly #parts: SessionParts;
  readonly #loader: AvatarLoader;
  #name = bodyLabelOf(defaultAvatar);
  /** What is shown; the loader's avatar itself is the tracker's. */
  #state: Omit<UserAvatarState, 'avatar'> = { worn: defaultAvatar, checked: null };
  #seatPalette: string | null = null;
  #pending: string | null = null;
  /** The number of requests, and that of the request that is shown. */
  #requested = 0;
  #shown = 0;
  #loading: Request | null = null;
  #waiting: (SkeletonToMap & { readonly checked: CheckedAvatar }) | null = null;

  constructor(parts: SessionParts, loader: AvatarLoader) {
    this.#parts = parts;
    this.#loader = loader;
  }

  get current(): Avatar | null {
    return this.#parts.tracker.avatar;
  }

  get name(): string {
    return this.#name;
  }

  /** What was assumed of its file, a sentence each. */
  get notes(): readonly string[] {
    return this.current?.notes ?? [];
  }

  /** Whether it is a built-in avatar, whose colours can be chosen. */
  get isBuiltIn(): boolean {
    return typeof this.worn === 'string';
  }

  /** The built-in avatar that is shown; null: it is a file. */
  get builtInBody(): BuiltInBody | null {
    return typeof this.worn === 'string' ? bodyOf(this.worn) : null;
  }

  /** The avatar for other players: the same object for as long as it is shown. */
  get worn(): OwnAvatar {
    return this.#state.worn;
  }

  /** The file that the user opened, as it is without a map of its bones; null: a built-in avatar. */
  get ownFile(): OwnFile | null {
    return this.#state.checked;
  }

  /** Returns the file of the avatar. Rejects with a reason if it can no longer be read. */
  file(): Promise<ArrayBuffer> {
    return typeof this.worn === 'string' ? fetchBuiltInAvatar(bodyOf(this.worn)) : this.worn.file.arrayBuffer();
  }

  /** The state of the last request in words; null: it is shown. */
  get pending(): string | null {
    return this.#pending;
  }

  /** Whether a file is loading, which the user can cancel. */
  get isLoading(): boolean {
    return this.#loading !== null;
  }

  /** Whether the shown avatar is a file, whose bones the user can correct. */
  get canCorrectBones(): boolean {
    return this.#state.checked !== null && this.#waiting === null && !this.isLoading;
  }

  /** A file whose bones the user maps; null: none. */
  get waiting(): SkeletonToMap | null {
    return this.#waiting;
  }

  /** Sets the palette of a seat; null: the palette that the user chose. */
  setSeatPalette(palette: string | null): void {
    this.#seatPalette = palette;
    this.recolour();
  }

  /** Applies the palette of the seat, else the user's, to a built-in avatar. */
  recolour(): void {
    const palette = this.#seatPalette ?? this.#parts.settings.palette;
    if (this.isBuiltIn) this.current?.setPalette(palette === ownColours ? null : palette);
  }

  /** Cancels the file that is loading or waits for its bones. The shown avatar stays. */
  cancel(): void {
    this.#loading?.cancellation.abort();
    this.#loading = null;
    this.#waiting = null;
    this.#pending = null;
    this.#parts.onChange();
  }

  /**
   * Shows the built-in avatar that the user chose. Requests before this are ignored when they arrive. `bytes`: its
   * file, if the download has started already. Returns false after a notice if it fails.
   */
  openBuiltIn(bytes?: Promise<ArrayBuffer>): Promise<boolean> {
    const { builtInBody, skinTone } = this.#parts.settings;
    const request = this.#request(bodyLabelOf(builtInBody), true);
    return this.#arrive(request, () => this.#loader.loadBuiltIn(builtInBody, skinTone, bytes));
  }

  /**
   * Shows the avatar of a file or an address. Returns false after a notice if it fails, and 'motion' where the file
   * holds motion and no body. Of several requests the last one is shown.
   */
  open(source: string | File): Promise<boolean | 'motion'> {
    const request = this.#request(fileNameOf(source), false);
    return this.#arrive(request, async () => {
      const { signal } = request.cancellation;
      request.checked = await this.#loader.check(source, { onProgress: this.#progressOf(request), signal });
      return this.#loader.build(request.checked);
    }).catch((error: unknown) => {
      if (!(error instanceof MotionOnlyError)) throw error;
      return 'motion' as const;
    });
  }

  /** Offers the bones of the shown file for correction: `waiting` has them. A failure becomes a notice. */
  async correctBones(): Promise<void> {
    const [state, turn] = [this.#state, this.#requested];
    const { checked, bones } = state;
    if (!checked) return;
    const { name } = checked;
    try {
      const { joints, matched, confidence, accepted } = await this.#loader.bonesOf(checked);
      if (this.#requested !== turn || this.#state !== state || this.#waiting) return;
      const [own, sure] = bones ? [bones, {}] : [matched, confidence];
      const canForgetMap = bones !== undefined && accepted;
      this.#waiting = {
        name,
        joints,
        bones: own,
        confidence: sure,
        complaint: null,
        isShown: true,
        canForgetMap,
        checked,
      };
    } catch (error) {
      const text = `The bones of ${name} could not be read: ${reasonFor(name, error)}. Open the file again.`;
      this.#parts.notices.show('error', text, 'avatar');
    } finally {
      this.#parts.onChange();
    }
  }

  /**
   * Maps the bones of the file that waits for them; null: forgets the user's map. Returns false if they do not fit;
   * `waiting` has the reason.
   */
  async applyBones(bones: BoneMap | null): Promise<boolean> {
    const waiting = this.#waiting;
    if (!waiting) return false;
    const { name, checked } = waiting;
    try {
      const loaded = await this.#loader.buildWith(checked, bones);
      if (this.#waiting !== waiting) {
        loaded.avatar.dispose();
        return false;
      }
      this.#requested += 1;
      this.#show(loaded, name, this.#requested);
      return true;
    } catch (error) {
      if (this.#waiting === waiting)
        this.#waiting = { ...waiting, bones: bones ?? waiting.bones, complaint: reasonFor(name, error) };
      return false;
    } finally {
      this.#parts.onChange();
    }
  }

  #request(name: string, isBuiltIn: boolean): Request {
    this.#requested += 1;
    const request: Request = {
      turn: this.#requested,
      name,
      isBuiltIn,
      cancellation: new AbortController(),
      checked: null,
    };
    this.#loading = isBuiltIn ? null : request;
    this.#waiting = null;
    this.#report(request, `${name} is loading.`);
    return request;
  }

  #report({ turn, isBuiltIn }: Request, text: string): void {
    if (turn !== this.#requested || isBuiltIn) return;
    this.#pending = text;
    this.#parts.onChange();
  }

  #progressOf(request: Request): (share: number) => void {
    const { name } = request;
    let reported = 0;
    return (share) => {
      const percent = Math.floor(share * 20) * 5;
      if (percent > reported)
        this.#report(request, percent < 100 ? `${name} is loading: ${percent} %.` : `${name} is being checked.`);
      reported = percent;
    };
  }

  /**
   * Shows the avatar that `load` returns, unless a later request has been shown before. Rejects only where the file
   * holds motion and no body.
   */
  async #arrive(request: Request, load: () => Promise<UserAvatarState>): Promise<boolean> {
    const { turn, name, cancellation } = request;
    try {
      const loaded = await load();
      if (turn < this.#shown || cancellation.signal.aborted) {
        loaded.avatar.dispose();
        return false;
      }
      this.#show(loaded, name, turn);
      return true;
    } catch (error) {
      if (cancellation.signal.aborted) return false;
      if (error instanceof MotionOnlyError) {
        if (turn === this.#requested) this.#pending = null;
        throw error;
      }
      this.#refuse(request, error);
      return false;
    } finally {
      if (this.#loading === request) this.#loading = null;
      this.#parts.onChange();
    }
  }

  #refuse({ turn, name, isBuiltIn, checked }: Request, error: unknown): void {
    const { notices } = this.#parts;
    const isNewest = turn === this.#requested;
    if (error instanceof UnknownBonesError && checked && isNewest) {
      const { joints, matched: bones, confidence } = error;
      const asked = { complaint: null, isShown: false, canForgetMap: false };
      this.#waiting = { name, joints, bones, confidence, ...asked, checked };
      this.#pending = `${name} is waiting for its bones to be mapped.`;
      const how = 'Map them by hand: Controls, Avatar, Bones of this file.';
      notices.show(
        'error',
        `${name} could not be shown. Its bones could not be matched to a humanoid. ${how}`,
        'avatar',
      );
      return;
    }
    notices.show('error', `${name} could not be shown: ${reasonFor(name, error)}`, 'avatar');
    if (isNewest) this.#pending = isBuiltIn ? null : `${name} could not be shown.`;
  }

  #show({ avatar, ...state }: UserAvatarState, name: string, turn: number): void {
    const { quality, tracker, settings, notices } = this.#parts;
    tracker.setAvatar(avatar);
    this.#name = name;
    this.#state = state;
    this.#shown = turn;
    this.#waiting = null;
    if (turn === this.#requested) {
      this.#pending = null;
      notices.withdraw('avatar');
    }
    this.recolour();
    if (typeof state.worn === 'string') {
      avatar.setSkinTone(skinToneOf(state.worn));
      avatar.setClothWeave(quality === 'high' ? weaveCloth : null);
    }
    avatar.setUpperBodyOnly(settings.upperBodyOnly);
  }
}
