import { type BoneMap, firstLine, reasonOf } from 'threepoint/core';
import { isSkeletonMap } from 'threepoint/internal';
import { type FileKind, fileNameOf, formatSentence, readLimited } from 'threepoint-ui';
import { isTable, purposeOfTable } from '../../mocap/table-files';
import { browserStorage } from '../session/preferences';
import { AvatarStore } from '../stage/avatar-store';
import type { StageParts } from '../stage/stage-parts';

/** Twice the size of the longest recording that the recorder stores. */
const recordingFile: FileKind = { what: 'a recording', megabytes: 100 };

const notStored = 'This browser cannot store it: open it again on your next visit.';

const isJson = ({ name }: File): boolean => /\.json$/i.test(name);
/** A map of a skeleton is a page of text, and so is the first line of a table [bytes]. */
const largestMap = 2 ** 18;
const isMocap = ({ name }: File): boolean => /\.(bvh|asf|amc|vrma|gltf)$/i.test(name);
/** Files with a body, its motion or both: bodies, unless they were chosen as motion. */
const mayBeMocap = ({ name }: File): boolean => /\.(fbx|glb)$/i.test(name);

/** Avatars, recordings and motion capture that the user brings along, as files of this device or as addresses. */
export class FileOpener {
  readonly #parts: StageParts;
  readonly #stored: Pick<AvatarStore, 'store' | 'read' | 'forget'>;

  /** `stored`: the user's own avatar, from one visit to the next. */
  constructor(parts: StageParts, stored = new AvatarStore(browserStorage('caches'))) {
    this.#parts = parts;
    this.#stored = stored;
  }

  /**
   * Files that came together: those of motion capture make one motion, others are opened one by one. `asMotion`: they
   * were chosen as motion capture.
   */
  openAll(files: readonly File[], { asMotion = false } = {}): void {
    const isMotion = (file: File): boolean => isMocap(file) || (asMotion && mayBeMocap(file));
    // Beside motion, JSON is a map of its skeleton.
    const mocap = files.some(isMotion) ? files.filter((file) => isMotion(file) || isJson(file)) : [];
    if (mocap.length > 0) void this.#parts.mocap.open(mocap);
    for (const file of files) if (!mocap.includes(file)) void this.open(file);
  }

  /**
   * A file by its ending: a recording or a map of a skeleton, else an avatar; a table is refused. Never rejects: what
   * goes wrong becomes a notice.
   */
  async open(file: File): Promise<void> {
    const requestNumber = this.#parts.recorder.nextRequest();
    if (isTable(file.name)) {
      const purpose = purposeOfTable(await file.slice(0, largestMap).text());
      this.#parts.notices.show('error', `${file.name} could not be opened: ${purpose}.`);
    } else if (!isJson(file)) await this.openAvatar(file);
    else if (file.size <= largestMap && isSkeletonMap(await file.text())) await this.#parts.mocap.open([file]);
    else await this.openRecording(file, requestNumber);
  }

  /** Shows an avatar; a file of motion without a body is opened as motion capture. */
  async openAvatar(source: string | File): Promise<void> {
    const { avatar, mocap } = this.#parts;
    const outcome = await avatar.open(source);
    if (outcome === 'motion') await mocap.open([source]);
    else if (outcome) await this.#keepAvatar('is your avatar now.');
  }

  /**
   * Sets the bones of the file that waits for them; null: forgets the user's map. Never rejects: the form shows what is
   * wrong.
   */
  async applyBones(bones: BoneMap | null): Promise<void> {
    const { avatar } = this.#parts;
    const text = avatar.waiting?.isShown ? 'has the new bones now.' : 'is your avatar now.';
    if (await avatar.applyBones(bones)) await this.#keepAvatar(text);
  }

  /** Shows the avatar of the last visit, if the user opened a file then. */
  async openStoredAvatar(): Promise<void> {
    const file = await this.#stored.read();
    if (file) await this.#parts.avatar.open(file);
  }

  /** Stores the avatar for later visits. Shows what happened to it, and what was assumed of its file. */
  async #keepAvatar(text: string): Promise<void> {
    const { avatar, notices } = this.#parts;
    const { ownFile, name, notes } = avatar;
    const isStored = ownFile === null || (await this.#stored.store(ownFile));
    const sentences = [`${name} ${text}`, ...notes.map(formatSentence), ...(isStored ? [] : [notStored])];
    notices.show('info', sentences.join(' '), 'avatar');
  }

  /** Shows the page's avatar, also after a reload. */
  showBuiltInAvatar(): void {
    void this.#stored.forget();
    const address = new URL(location.href);
    address.searchParams.delete('avatar');
    history.replaceState(null, '', address);
    void this.#parts.avatar.openBuiltIn();
  }

  /**
   * Replays a recording, with the body of the person in it. `requestNumber`: its number among the recorder's requests.
   * Never rejects: what goes wrong becomes a notice.
   */
  async openRecording(source: string | File, requestNumber = this.#parts.recorder.nextRequest()): Promise<void> {
    const { recorder, notices } = this.#parts;
    const name = fileNameOf(source);
    try {
      recorder.open(name, new TextDecoder().decode(await readLimited(source, recordingFile)), requestNumber);
      this.replay();
      notices.withdraw('recording');
    } catch (error) {
      const reason = firstLine(reasonOf(error)).replace(`${name}: `, '');
      notices.show('error', `${name} could not be replayed: ${reason}`, 'recording');
    }
  }

  /** Replays the current recording from its start. */
  replay(): void {
    const { recorder, body, onChange } = this.#parts;
    recorder.replay();
    body.discontinuity();
    onChange();
  }
}

/** Takes files dropped anywhere on the page, and shows where they may be dropped while one is dragged. */
export function acceptDroppedFiles(onFiles: (files: readonly File[]) => void): void {
  let depth = 0;
  const hover = (by: number) => {
    depth = Math.max(0, depth + by);
    document.body.classList.toggle('dragging', depth > 0);
  };
  window.addEventListener('dragenter', () => hover(1));
  window.addEventListener('dragleave', () => hover(-1));
  window.addEventListener('dragover', (event) => event.preventDefault());
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    depth = 0;
    hover(0);
    onFiles([...(event.dataTransfer?.files ?? [])]);
  });
}
