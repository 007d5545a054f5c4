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

/** An avatar that was asked for. */
interface Wanted {
  readonly name: string;
  readonly own: boolean;
  /** Brings it; `onProgress` hears the share of its file [0, 1] that has come. */
  load(signal: AbortSignal, onProgress: (share: number) => void): Promise<LoadedAvatar>;
}

/** The avatar on the stage. One is shown at a time; another takes its place only when it has arrived whole. */
export class ShownAvatar {
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

  /** null: none has arrived yet. */
  get current(): Avatar | null {
    return this.#avatar;
  }

  get name(): string {
    return this.#name;
  }

  /** Whether it is our own, whose colours can be chosen. */
  get own(): boolean {
    return this.#own;
  }

  /** What became of the avatar that was asked for last, in words: on its way, or refused; null: it is shown. */
  get pending(): string | null {
    return this.#pending;
  }

  /** Whether another is on its way that can be given up. */
  get onItsWay(): boolean {
    return this.#giveUp !== null;
  }

  /** Gives up what is on its way; what is shown stays. */
  cancel(): void {
    this.#giveUp?.abort();
    this.#giveUp = null;
    this.#pending = null;
    this.#options.onChange();
  }

  /**
   * Our own takes its place, or stays there; what is still on its way is not waited for. `bytes`: its file, where that travels already.
   * False and a notice where it cannot be had.
   */
  openOwn(bytes: Promise<ArrayBuffer> = fetchOwnAvatar()): Promise<boolean> {
    return this.#arrive({ name: ownName, own: true, load: async () => parseAvatar(await bytes, ownName) });
  }

  /** Loads another; what goes wrong becomes a notice, and false. Of several the one asked for last is shown. */
  open(source: string | File): Promise<boolean> {
    const name = nameOf(source);
    return this.#arrive({
      name,
      own: false,
      async load(signal, onProgress) {
        const bytes = await readLimited(source, avatarFile, onProgress, signal);
        return loadAvatar(bytes, name, validateInWorker, decoders);
      },
    });
  }

  /** One of our own avatar's palettes; null: the one the user chose. */
  wear(palette: string | null): void {
    if (this.#own) this.#avatar?.setPalette(palette ?? this.#options.settings.palette);
  }

  /** Shows what was asked for unless something that was asked for later has come before it. */
  async #arrive(wanted: Wanted): Promise<boolean> {
    this.#asked += 1;
    const turn = this.#asked;
    const ending = new AbortController();
    this.#giveUp = wanted.own ? null : ending;
    this.#tell(wanted, turn, '');
    try {
      const loaded = await wanted.load(ending.signal, this.#progressOf(wanted, turn));
      if (turn < this.#shown || ending.signal.aborted) {
        VRMUtils.deepDispose(loaded.vrm.scene);
        return false;
      }
      this.#show(createAvatar(loaded), wanted);
      this.#shown = turn;
      if (turn === this.#asked) this.#pending = null;
      return true;
    } catch (error) {
      if (!ending.signal.aborted) this.#refuse(wanted, turn, error);
      return false;
    } finally {
      if (this.#giveUp === ending) this.#giveUp = null;
      this.#options.onChange();
    }
  }

  #show(avatar: Avatar, { name, own }: Wanted): void {
    const { scene, settings, body } = this.#options;
    this.#avatar?.dispose();
    this.#avatar = avatar;
    this.#name = name;
    this.#own = own;
    scene.add(avatar.object);
    this.wear(null);
    avatar.setUpperBodyOnly(settings.upperBodyOnly);
    avatar.fitTo(body.calibration);
  }

  #refuse({ name, own }: Wanted, turn: number, error: unknown): void {
    const reason = firstLine(reasonOf(error)).replace(`${name}: `, '');
    this.#options.notices.show('error', `${name} could not be shown: ${reason}`);
    if (turn === this.#asked) this.#pending = own ? null : `${name} could not be shown.`;
  }

  /** Tells how far it has come, in steps of five percent. */
  #progressOf(wanted: Wanted, turn: number): (share: number) => void {
    let told = 0;
    return (share) => {
      const percent = Math.floor(share * 20) * 5;
      if (percent > told) this.#tell(wanted, turn, percent < 100 ? `: ${percent} %` : ': it is being looked at');
      told = percent;
    };
  }

  /** Says that it is on its way, unless another has been asked for since. Our own comes without a word. */
  #tell({ name, own }: Wanted, turn: number, how: string): void {
    if (turn !== this.#asked || own) return;
    this.#pending = `${name} is on its way${how}.`;
    this.#options.onChange();
  }
}
