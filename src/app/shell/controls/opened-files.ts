import type { BoneMap } from '../../../avatar/bone-names';
import { firstLine, reasonOf } from '../../../core/errors/reasons';
import type { BareBody } from '../../../lib/bare-body';
import { type FileKind, nameOf, readLimited } from '../../../ui/limited-files';
import type { Notices } from '../../../ui/notices';
import type { Recorder } from '../../studio/recorder';
import type { PageMocap } from '../page-mocap';
import type { ShownAvatar } from '../shown-avatar';

/** Twice what the recorder keeps at most. */
const recordingFile: FileKind = { what: 'a recording', megabytes: 100 };

export interface OpenedFilesOptions {
  readonly avatar: Pick<ShownAvatar, 'open' | 'openOwn' | 'giveBones' | 'name'>;
  readonly recorder: Pick<Recorder, 'open' | 'replay'>;
  readonly notices: Pick<Notices, 'show'>;
  readonly body: Pick<BareBody, 'jumped'>;
  readonly mocap: Pick<PageMocap, 'open'>;
  onChange(): void;
}

const isMocap = ({ name }: File): boolean => /\.(bvh|asf|amc|vrma)$/i.test(name);

/** Avatars, recordings and motion capture that the user brings along, as files of this device or as addresses. */
export class OpenedFiles {
  readonly #options: OpenedFilesOptions;

  constructor(options: OpenedFilesOptions) {
    this.#options = options;
  }

  /** Files that came together: those of motion capture make one motion, others are opened one by one. */
  openAll(files: readonly File[]): void {
    const mocap = files.filter(isMocap);
    if (mocap.length > 0) void this.#options.mocap.open(mocap);
    for (const file of files) if (!isMocap(file)) void this.open(file);
  }

  /** A file by its ending: a recording, else an avatar. Never rejects: what goes wrong becomes a notice. */
  async open(file: File): Promise<void> {
    if (/\.json$/i.test(file.name)) await this.openRecording(file);
    else await this.openAvatar(file);
  }

  async openAvatar(source: string | File): Promise<void> {
    const { avatar, notices } = this.#options;
    if (await avatar.open(source)) notices.show('info', `${avatar.name} is your avatar now.`);
  }

  /** The bones of the file that waits for them. Never rejects: what is wrong stands where they are told. */
  async giveBones(bones: BoneMap): Promise<void> {
    const { avatar, notices } = this.#options;
    if (await avatar.giveBones(bones)) notices.show('info', `${avatar.name} is your avatar now.`);
  }

  /** Ours, also after a reload. */
  showOwnAvatar(): void {
    const address = new URL(location.href);
    address.searchParams.delete('avatar');
    history.replaceState(null, '', address);
    void this.#options.avatar.openOwn();
  }

  /** Replays what the file keeps, with the body of the person in it. Never rejects: what goes wrong becomes a notice. */
  async openRecording(source: string | File): Promise<void> {
    const { recorder, notices } = this.#options;
    const name = nameOf(source);
    try {
      recorder.open(name, new TextDecoder().decode(await readLimited(source, recordingFile)));
      this.replay();
    } catch (error) {
      const reason = firstLine(reasonOf(error)).replace(`${name}: `, '');
      notices.show('error', `${name} could not be replayed: ${reason}`);
    }
  }

  /** The recording at hand, from its beginning. */
  replay(): void {
    const { recorder, body, onChange } = this.#options;
    recorder.replay();
    body.jumped();
    onChange();
  }
}
