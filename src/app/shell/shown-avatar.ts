import { VRMUtils } from '@pixiv/three-vrm';
import { type Avatar, createAvatar } from '../../avatar/avatar';
import { decoders } from '../../avatar/decoders';
import { avatarLimits } from '../../avatar/inspect-avatar';
import { type LoadedAvatar, loadAvatar, parseAvatar } from '../../avatar/load-avatar';
import { validateInWorker } from '../../avatar/validate-in-worker';
import { firstLine, reasonOf } from '../../core/errors/reasons';
import type { BareBody } from '../../lib/bare-body';
import { type FileKind, nameOf, readLimited } from '../../ui/limited-files';
import type { Notices } from '../../ui/notices';
import { pageFolder } from '../../ui/page-folder';
import type { Studio } from '../studio/studio';
import type { Settings } from './settings';

export interface ShownAvatarOptions {
  readonly scene: Studio['scene'];
  readonly settings: Pick<Settings, 'palette' | 'upperBodyOnly'>;
  readonly body: Pick<BareBody, 'calibration'>;
  readonly notices: Pick<Notices, 'show'>;
  onChange(): void;
}

/** A body from a file. */
export const avatarFile: FileKind = { what: 'an avatar', megabytes: avatarLimits.megabytes };
const ownName = 'Mannequin';

/** The file of our own avatar, which lies beside the page, on its way; `onProgress` hears the share [0, 1] that has come. */
export const fetchOwnAvatar = (onProgress?: (share: number) => void): Promise<ArrayBuffer> =>
  readLimited(`${pageFolder()}/avatars/mannequin.vrm`, avatarFile, onProgress);

/** The avatar on the stage. One is shown at a time; another takes its place only when it has arrived whole. */
export interface ShownAvatar {
  /** null: none has arrived yet. */
  readonly current: Avatar | null;
  readonly name: string;
  /** Whether it is our own, whose colours can be chosen. */
  readonly own: boolean;
  /** What became of the avatar that was asked for last, in words: on its way, or refused; null: it is shown. */
  readonly pending: string | null;
  /**
   * Our own takes its place, or stays there; what is still on its way is not waited for. `bytes`: its file, where that travels already.
   * False and a notice where it cannot be had.
   */
  openOwn(bytes?: Promise<ArrayBuffer>): Promise<boolean>;
  /** Whether another is on its way that can be given up. */
  readonly onItsWay: boolean;
  /** Gives up what is on its way; what is shown stays. */
  cancel(): void;
  /** Loads another; what goes wrong becomes a notice, and false. Of several the one asked for last is shown. */
  open(source: string | File): Promise<boolean>;
  /** One of our own avatar's palettes; null: the one the user chose. */
  wear(palette: string | null): void;
}

/** Brings an avatar; `onProgress` hears the share of it [0, 1] that has arrived. */
type Load = (signal: AbortSignal, onProgress: (share: number) => void) => Promise<LoadedAvatar>;

class OneShownAvatar implements ShownAvatar {
  readonly #options: ShownAvatarOptions;
  #avatar: Avatar | null = null;
  #name = ownName;
  #own = true;
  #pending: string | null = null;
  /** Counts what was asked for; and which of that is shown. */
  #asked = 0;
  #shown = 0;
  /** Ends what is on its way; null: nothing is. */
  #giveUp: AbortController | null = null;

  constructor(options: ShownAvatarOptions) {
    this.#options = options;
  }

  get current(): Avatar | null {
    return this.#avatar;
  }

  get name(): string {
    return this.#name;
  }

  get own(): boolean {
    return this.#own;
  }

  get pending(): string | null {
    return this.#pending;
  }

  get onItsWay(): boolean {
    return this.#giveUp !== null;
  }

  cancel(): void {
    this.#giveUp?.abort();
    this.#giveUp = null;
    this.#pending = null;
    this.#options.onChange();
  }

  openOwn(bytes: Promise<ArrayBuffer> = fetchOwnAvatar()): Promise<boolean> {
    return this.#arrive(async () => parseAvatar(await bytes, ownName), ownName, true);
  }

  open(source: string | File): Promise<boolean> {
    const name = nameOf(source);
    return this.#arrive(
      async (signal, onProgress) =>
        loadAvatar(await readLimited(source, avatarFile, onProgress, signal), name, validateInWorker, decoders),
      name,
      false,
    );
  }

  wear(palette: string | null): void {
    if (this.#own) this.#avatar?.setPalette(palette ?? this.#options.settings.palette);
  }

  #show(next: Avatar, name: string, own: boolean): void {
    const { scene, settings, body } = this.#options;
    this.#avatar?.dispose();
    this.#avatar = next;
    this.#name = name;
    this.#own = own;
    scene.add(next.object);
    this.wear(null);
    next.setUpperBodyOnly(settings.upperBodyOnly);
    next.fitTo(body.calibration);
  }

  /** Shows what `load` brings unless something that was asked for later has come before it. */
  async #arrive(load: Load, name: string, own: boolean): Promise<boolean> {
    this.#asked += 1;
    const turn = this.#asked;
    const ending = new AbortController();
    this.#giveUp = own ? null : ending;
    this.#tell(turn, name, own, '');
    try {
      const loaded = await load(ending.signal, this.#progress(turn, name, own));
      if (turn < this.#shown || ending.signal.aborted) {
        VRMUtils.deepDispose(loaded.vrm.scene);
        return false;
      }
      this.#show(createAvatar(loaded), name, own);
      this.#shown = turn;
      if (turn === this.#asked) this.#pending = null;
      return true;
    } catch (error) {
      if (ending.signal.aborted) return false;
      const reason = firstLine(reasonOf(error)).replace(`${name}: `, '');
      this.#options.notices.show('error', `${name} could not be shown: ${reason}`);
      if (turn === this.#asked) this.#pending = own ? null : `${name} could not be shown.`;
      return false;
    } finally {
      if (this.#giveUp === ending) this.#giveUp = null;
      this.#options.onChange();
    }
  }

  /** Tells how far an avatar has come, in steps of five percent. */
  #progress(turn: number, name: string, own: boolean): (share: number) => void {
    let told = 0;
    return (share) => {
      const percent = Math.floor(share * 20) * 5;
      if (percent > told) this.#tell(turn, name, own, percent < 100 ? `: ${percent} %` : ': it is being looked at');
      told = percent;
    };
  }

  /** Says that an avatar of the user is on its way, unless another has been asked for since. */
  #tell(turn: number, name: string, own: boolean, how: string): void {
    if (turn !== this.#asked || own) return;
    this.#pending = `${name} is on its way${how}.`;
    this.#options.onChange();
  }
}

export const createShownAvatar = (options: ShownAvatarOptions): ShownAvatar => new OneShownAvatar(options);
