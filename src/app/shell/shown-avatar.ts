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

export function createShownAvatar(options: ShownAvatarOptions): ShownAvatar {
  const { scene, settings, body, notices, onChange } = options;
  let avatar: Avatar | null = null;
  let name = ownName;
  let own = true;
  let pending: string | null = null;
  /** Counts what was asked for; and which of that is shown. */
  let asked = 0;
  /** Ends what is on its way; null: nothing is. */
  let giveUp: AbortController | null = null;
  let shown = 0;

  function wear(palette: string | null): void {
    if (own) avatar?.setPalette(palette ?? settings.palette);
  }

  function show(next: Avatar, itsName: string, isOwn: boolean): void {
    avatar?.dispose();
    avatar = next;
    name = itsName;
    own = isOwn;
    scene.add(avatar.object);
    wear(null);
    avatar.setUpperBodyOnly(settings.upperBodyOnly);
    avatar.fitTo(body.calibration);
  }

  /** Shows what `load` brings unless something that was asked for later has come before it. */
  async function arrive(
    load: (signal: AbortSignal, onProgress: (share: number) => void) => Promise<LoadedAvatar>,
    itsName: string,
    isOwn: boolean,
  ): Promise<boolean> {
    asked += 1;
    const turn = asked;
    const ending = new AbortController();
    const tell = (how: string) => {
      if (turn !== asked || isOwn) return;
      pending = `${itsName} is on its way${how}.`;
      onChange();
    };
    giveUp = isOwn ? null : ending;
    tell('');
    let told = 0;
    try {
      const loaded = await load(ending.signal, (share) => {
        const percent = Math.floor(share * 20) * 5;
        if (percent > told) tell(percent < 100 ? `: ${percent} %` : ': it is being looked at');
        told = percent;
      });
      if (turn < shown || ending.signal.aborted) {
        VRMUtils.deepDispose(loaded.vrm.scene);
        return false;
      }
      show(createAvatar(loaded), itsName, isOwn);
      shown = turn;
      if (turn === asked) pending = null;
      return true;
    } catch (error) {
      if (ending.signal.aborted) return false;
      const reason = firstLine(reasonOf(error)).replace(`${itsName}: `, '');
      notices.show('error', `${itsName} could not be shown: ${reason}`);
      if (turn === asked) pending = isOwn ? null : `${itsName} could not be shown.`;
      return false;
    } finally {
      if (giveUp === ending) giveUp = null;
      onChange();
    }
  }

  return {
    get current() {
      return avatar;
    },
    get name() {
      return name;
    },
    get own() {
      return own;
    },
    get pending() {
      return pending;
    },
    get onItsWay() {
      return giveUp !== null;
    },
    cancel() {
      giveUp?.abort();
      giveUp = null;
      pending = null;
      onChange();
    },
    openOwn: (bytes = fetchOwnAvatar()) => arrive(async () => parseAvatar(await bytes, ownName), ownName, true),
    open(source) {
      const itsName = nameOf(source);
      return arrive(
        async (signal, onProgress) =>
          loadAvatar(await readLimited(source, avatarFile, onProgress, signal), itsName, validateInWorker, decoders),
        itsName,
        false,
      );
    },
    wear,
  };
}
