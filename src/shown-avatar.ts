import { type Avatar, createAvatar } from './avatar/avatar';
import { loadAvatar } from './avatar/load-avatar';
import { validateInWorker } from './avatar/validate-in-worker';
import type { Calibration } from './core/body/calibration';
import { firstLine, reasonOf } from './reasons';
import type { Arena } from './scene/arena';
import type { Settings } from './settings';
import type { Notices } from './ui/notices';

/** Where our own avatar lies, on our own server. */
export const ownAvatarAt = '/avatars/mannequin.vrm';

export interface ShownAvatarOptions {
  scene(): Arena['scene'];
  readonly settings: Pick<Settings, 'palette' | 'upperBodyOnly'>;
  /** Of whoever moves. */
  body(): Calibration;
  readonly notices: Pick<Notices, 'show'>;
  onChange(): void;
}

/** The avatar on the stage. One is shown at a time; another takes its place only when it has arrived whole. */
export interface ShownAvatar {
  /** null: none has arrived yet. */
  readonly current: Avatar | null;
  readonly name: string;
  /** Whether it is our own, whose colours can be chosen. */
  readonly own: boolean;
  /** Loads another; what goes wrong becomes a notice, and false. A source of null is our own avatar. */
  open(source: string | File | null, name: string, onProgress?: (part: number) => void): Promise<boolean>;
  /** One of our own avatar's palettes; null: the one the user chose. */
  wear(palette: string | null): void;
}

export function createShownAvatar(options: ShownAvatarOptions): ShownAvatar {
  const { scene, settings, body, notices, onChange } = options;
  let avatar: Avatar | null = null;
  let name = 'Mannequin';
  let own = true;

  function wear(palette: string | null): void {
    if (own) avatar?.setPalette(palette ?? settings.palette);
  }

  function show(next: Avatar, itsName: string, isOwn: boolean): void {
    avatar?.dispose();
    avatar = next;
    name = itsName;
    own = isOwn;
    scene().add(avatar.object);
    wear(null);
    avatar.setUpperBodyOnly(settings.upperBodyOnly);
    avatar.fitTo(body());
    onChange();
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
    async open(source, itsName, onProgress) {
      try {
        const loaded = await loadAvatar(source ?? ownAvatarAt, {
          ...(onProgress && { onProgress }),
          ...(source && { validate: validateInWorker }),
        });
        show(createAvatar(loaded), itsName, source === null);
        return true;
      } catch (error) {
        notices.show('error', `${itsName} could not be shown: ${firstLine(reasonOf(error))}`);
        return false;
      }
    },
    wear,
  };
}
