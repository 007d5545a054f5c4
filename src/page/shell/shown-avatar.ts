import type { BodySolver } from 'threepoint/api/body-solver';
import { type Avatar, createAvatarBetweenFrames } from 'threepoint/avatar/avatar';
import { decoders } from 'threepoint/avatar/decoders/decoders';
import type { CheckedAvatar } from 'threepoint/avatar/file/check-avatar';
import { checkInWorker } from 'threepoint/avatar/file/check-in-worker';
import { hashOf } from 'threepoint/avatar/file/file-hash';
import { avatarLimits } from 'threepoint/avatar/file/inspect-avatar';
import type { BoneMap } from 'threepoint/avatar/humanoid/bone-names';
import { withNamedBones } from 'threepoint/avatar/humanoid/name-bones';
import { UnknownBones } from 'threepoint/avatar/humanoid/unknown-bones';
import { parseAvatar, parseChecked } from 'threepoint/avatar/load-avatar';
import { labelOf } from 'threepoint/avatar/own-bodies';
import { bodyOf, type OwnBody, ownAvatarOf, plainAvatar, skinToneOf } from 'threepoint/core/body/avatar-ref';
import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import { type FileKind, nameOf, readLimited } from 'threepoint-ui/limited-files';
import type { Notices } from 'threepoint-ui/notices';
import { pageFolder } from 'threepoint-ui/page-folder';
import type { OwnWear } from '../ball/shared-avatar';
import type { Studio } from '../studio/studio';
import type { KnownBones } from './known-bones';
import type { Settings } from './settings';

export interface ShownAvatarOptions {
  readonly scene: Studio['scene'];
  readonly settings: Pick<Settings, 'palette' | 'upperBodyOnly' | 'ownBody' | 'skinTone'>;
  readonly body: Pick<BodySolver, 'calibration'>;
  readonly notices: Pick<Notices, 'show'>;
  /** The maps of bones that were given for files of unknown naming. */
  readonly knownBones: Pick<KnownBones, 'of' | 'keep'>;
  /** Brings what a body needs to the graphics device before it is shown. */
  prepare(object: Avatar['object']): Promise<void>;
  onChange(): void;
}

/** A body from a file. */
export const avatarFile: FileKind = { what: 'an avatar', megabytes: avatarLimits.megabytes };
const howToTell = 'Say which is which: Controls, Avatar, Bones of this file.';

/** The file of one of our own bodies, which lie beside the page, on its way; `onProgress` hears the share [0, 1] that has come. */
export const fetchOwnAvatar = (name: OwnBody, onProgress?: (share: number) => void): Promise<ArrayBuffer> =>
  readLimited(`${pageFolder()}/avatars/${name}.vrm`, avatarFile, onProgress && { onProgress });

/** A file that came whole, but whose bones are to be told first. */
export interface WaitingForBones {
  readonly name: string;
  /** What the file calls its bones. */
  readonly found: readonly string[];
  /** Those that are known, or were given last. */
  readonly bones: BoneMap;
  /** What is wrong with them, in a sentence; null: nothing was given yet. */
  readonly complaint: string | null;
}

/** A file as others can read it, who know no map of its bones; its hash is null where this page cannot tell it. */
async function fileFor({ bytes, hash }: CheckedAvatar, bones: BoneMap | undefined) {
  if (!bones) return { file: new Blob([bytes]), hash };
  const named = await withNamedBones(bytes, bones);
  return { file: new Blob([named]), hash: await hashOf(named) };
}

/** A body that has come, what to call it, and as what it is told to others. */
interface Arrived {
  readonly avatar: Avatar;
  readonly worn: OwnWear;
}

/** What was asked for, until it is shown, refused or given up. */
interface Asked {
  readonly turn: number;
  readonly name: string;
  readonly own: boolean;
  readonly ending: AbortController;
  /** The file, once it has come whole; null: not yet, or it is one of ours. */
  checked: CheckedAvatar | null;
}

/** The avatar on the stage. One is shown at a time; another takes its place only when it has arrived whole. */
export class ShownAvatar {
  readonly #options: ShownAvatarOptions;
  #avatar: Avatar | null = null;
  #name = labelOf(plainAvatar);
  #worn: OwnWear = plainAvatar;
  #seatPalette: string | null = null;
  #pending: string | null = null;
  /** Counts what was asked for; and which of that is shown. */
  #asked = 0;
  #shown = 0;
  /** What is on its way and can be given up; null: nothing is. */
  #coming: Asked | null = null;
  #waiting: (WaitingForBones & { readonly checked: CheckedAvatar }) | null = null;

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
    return typeof this.#worn === 'string';
  }

  /** Which of our own it is; null: another. */
  get ownBody(): OwnBody | null {
    return typeof this.#worn === 'string' ? bodyOf(this.#worn) : null;
  }

  /** As what it is told to others: the same object for as long as it is shown. */
  get worn(): OwnWear {
    return this.#worn;
  }

  /** The file of the avatar that is shown. Rejects with a sentence where it can be had no longer. */
  file(): Promise<ArrayBuffer> {
    return typeof this.#worn === 'string' ? fetchOwnAvatar(bodyOf(this.#worn)) : this.#worn.file.arrayBuffer();
  }

  /** What became of the avatar that was asked for last, in words: on its way, or refused; null: it is shown. */
  get pending(): string | null {
    return this.#pending;
  }

  /** Whether another is on its way that can be given up. */
  get onItsWay(): boolean {
    return this.#coming !== null;
  }

  /** A file whose bones are to be told; null: none. */
  get waiting(): WaitingForBones | null {
    return this.#waiting;
  }

  /** The palette of a seat; null: the one the user chose. */
  wear(palette: string | null): void {
    this.#seatPalette = palette;
    this.recolour();
  }

  /** The palette of the seat, else the one the user chose, is on our own bodies. */
  recolour(): void {
    if (this.own) this.#avatar?.setPalette(this.#seatPalette ?? this.#options.settings.palette);
  }

  /** Gives up what is on its way, or waits for its bones; what is shown stays. */
  cancel(): void {
    this.#coming?.ending.abort();
    this.#coming = null;
    this.#waiting = null;
    this.#pending = null;
    this.#options.onChange();
  }

  /**
   * The body of our own that the user chose takes its place, or stays there; what is still on its way is not waited for. `bytes`: its file, where
   * that travels already. False and a notice where it cannot be had.
   */
  openOwn(bytes?: Promise<ArrayBuffer>): Promise<boolean> {
    const { ownBody, skinTone } = this.#options.settings;
    const label = labelOf(ownBody);
    return this.#arrive(this.#ask(label, true), async () => ({
      avatar: await createAvatarBetweenFrames(await parseAvatar(await (bytes ?? fetchOwnAvatar(ownBody)), label)),
      worn: ownAvatarOf(ownBody, skinTone),
    }));
  }

  /** Loads another; what goes wrong becomes a notice, and false. Of several the one asked for last is shown. */
  open(source: string | File): Promise<boolean> {
    const asked = this.#ask(nameOf(source), false);
    return this.#arrive(asked, async () => {
      const { signal } = asked.ending;
      const bytes = await readLimited(source, avatarFile, { onProgress: this.#progressOf(asked), signal });
      const checked = await checkInWorker(bytes, { name: asked.name, unpacked: Object.keys(decoders) });
      asked.checked = checked;
      const bones = checked.hash === null ? undefined : this.#options.knownBones.of(checked.hash);
      return this.#read(checked, asked.name, bones);
    });
  }

  /** The file that waits for them has these bones. False, and what is wrong in `waiting`, where it does not. */
  async giveBones(bones: BoneMap): Promise<boolean> {
    const waiting = this.#waiting;
    if (!waiting) return false;
    const { name, checked } = waiting;
    try {
      const arrived = await this.#read(checked, name, bones);
      if (this.#waiting !== waiting) {
        arrived.avatar.dispose();
        return false;
      }
      if (checked.hash !== null) this.#options.knownBones.keep(checked.hash, bones);
      this.#asked += 1;
      this.#show(arrived, name, this.#asked);
      return true;
    } catch (error) {
      const complaint = firstLine(reasonOf(error)).replace(`${name}: `, '');
      if (this.#waiting === waiting) this.#waiting = { ...waiting, bones, complaint };
      return false;
    } finally {
      this.#options.onChange();
    }
  }

  async #read(checked: CheckedAvatar, name: string, bones: BoneMap | undefined): Promise<Arrived> {
    const avatar = await createAvatarBetweenFrames(await parseChecked(checked, name, { decoders, bones }));
    try {
      await this.#options.prepare(avatar.object);
      return { avatar, worn: { name, ...(await fileFor(checked, bones)) } };
    } catch (error) {
      avatar.dispose();
      throw error;
    }
  }

  #ask(name: string, own: boolean): Asked {
    this.#asked += 1;
    const asked: Asked = { turn: this.#asked, name, own, ending: new AbortController(), checked: null };
    this.#coming = own ? null : asked;
    this.#waiting = null;
    this.#tell(asked, '');
    return asked;
  }

  #tell({ turn, own, name }: Asked, how: string): void {
    if (turn !== this.#asked || own) return;
    this.#pending = `${name} is on its way${how}.`;
    this.#options.onChange();
  }

  #progressOf(asked: Asked): (share: number) => void {
    let told = 0;
    return (share) => {
      const percent = Math.floor(share * 20) * 5;
      if (percent > told) this.#tell(asked, percent < 100 ? `: ${percent} %` : ': it is being looked at');
      told = percent;
    };
  }

  /** Shows what `load` brings unless something that was asked for later has come before it. */
  async #arrive(asked: Asked, load: () => Promise<Arrived>): Promise<boolean> {
    const { turn, name, own, ending } = asked;
    try {
      const arrived = await load();
      if (turn < this.#shown || ending.signal.aborted) {
        arrived.avatar.dispose();
        return false;
      }
      this.#show(arrived, name, turn);
      return true;
    } catch (error) {
      if (ending.signal.aborted) return false;
      if (error instanceof UnknownBones && asked.checked && turn === this.#asked) {
        const { found, matched: told } = error;
        this.#waiting = { name, found, bones: told, complaint: null, checked: asked.checked };
        this.#options.notices.show(
          'error',
          `${name} could not be shown: the names of its bones tell no body. ${howToTell}`,
        );
        this.#pending = `${name} waits to be told which bone is which.`;
        return false;
      }
      const reason = firstLine(reasonOf(error)).replace(`${name}: `, '');
      this.#options.notices.show('error', `${name} could not be shown: ${reason}`);
      if (turn === this.#asked) this.#pending = own ? null : `${name} could not be shown.`;
      return false;
    } finally {
      if (this.#coming === asked) this.#coming = null;
      this.#options.onChange();
    }
  }

  #show({ avatar, worn }: Arrived, name: string, turn: number): void {
    const { scene, settings, body } = this.#options;
    this.#avatar?.dispose();
    this.#avatar = avatar;
    this.#name = name;
    this.#worn = worn;
    this.#shown = turn;
    this.#waiting = null;
    if (turn === this.#asked) this.#pending = null;
    scene.add(avatar.object);
    this.recolour();
    if (typeof worn === 'string') avatar.setSkinTone(skinToneOf(worn));
    avatar.setUpperBodyOnly(settings.upperBodyOnly);
    avatar.setCalibration(body.calibration);
  }
}
