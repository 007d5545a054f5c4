import { firstLine, reasonOf } from 'threepoint/core';
import { exportMotion, type MotionFormat, type MotionWriter } from 'threepoint/motion';
import { avatarMotionWriter } from 'threepoint/three';
import { offerDownload } from 'threepoint-ui';
import { createDecodingLoader } from '../../scene/decoders';
import { estimatorTexts } from '../session/estimator-texts';
import type { StageParts } from '../stage/stage-parts';
import type { ExportChoice, ExportState } from './panel-state';

/** Exports the current recording to files for other programs, one at a time. Its code is loaded on first use. */
export class MotionExport {
  readonly #parts: StageParts;
  #state: ExportState | null = null;
  #cancellation = new AbortController();

  constructor(parts: StageParts) {
    this.#parts = parts;
  }

  /** The progress of the export; null: none is in progress. */
  get state(): ExportState | null {
    return this.#state;
  }

  cancel(): void {
    this.#cancellation.abort();
  }

  /**
   * Exports the current recording with the chosen method, unless an export is in progress. Never rejects: faults become
   * notices.
   */
  async begin(choice: ExportChoice): Promise<void> {
    const { recorder, body, notices } = this.#parts;
    const { recording, name } = recorder;
    if (!recording || !name || this.#state) return;
    const estimator = body.selectedEstimator;
    const stem = name.replace(/\.json$/i, '');
    const { label } = estimatorTexts[estimator];
    this.#cancellation = new AbortController();
    const { signal } = this.#cancellation;
    this.#setState({ name: stem, method: label, fraction: 0, secondsLeft: null });
    try {
      const { extension, type, parts } = await exportMotion(recording, {
        format: await this.#formatOf(choice),
        unit: choice === 'bvh-cm' ? 'cm' : 'm',
        estimator,
        networks: this.#parts.networks,
        calibration: recording.calibration ?? body.userCalibration,
        signal,
        onProgress: (progress) => this.#setState({ name: stem, method: label, ...progress }),
      });
      // The name says what is in the file, so that it never replaces what was recorded.
      const file = `${stem}-${estimator}${choice === 'bvh-cm' ? '-cm' : ''}.${extension}`;
      offerDownload(file, type, new Blob([...parts], { type }));
      notices.show('info', `${file} is ready: the body as drawn by ${label}.`, 'export');
    } catch (error) {
      if (!signal.aborted)
        notices.show('error', `${stem} could not be exported: ${firstLine(reasonOf(error))}`, 'export');
    } finally {
      this.#setState(null);
    }
  }

  async #formatOf(choice: ExportChoice): Promise<MotionFormat | MotionWriter> {
    if (choice !== 'glb') return choice === 'bvh-cm' ? 'bvh' : choice;
    const { avatar } = this.#parts;
    const loader = await createDecodingLoader();
    return avatarMotionWriter(new File([await avatar.file()], avatar.name), { loader });
  }

  #setState(state: ExportState | null): void {
    this.#state = state;
    this.#parts.onChange();
  }
}
