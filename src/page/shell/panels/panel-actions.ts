import {
  armSpanFromFingertipSpan,
  type BoneMap,
  type BuiltInBody,
  calibrationProblem,
  type EstimatorName,
  eyeHeightFromStature,
  type SkinTone,
} from 'threepoint/core';
import { offerDownload } from 'threepoint-ui';
import type { ViewName } from '../../scene/desktop-view';
import type { CalibrationControl } from '../input/calibration-control';
import type { FileOpener } from '../input/file-opener';
import type { Settings, StoredSettings } from '../session/settings';
import type { StageParts } from '../stage/stage-parts';
import { GripControl } from './grip-control';
import type { MotionExport } from './motion-export';
import type { ExportChoice, PanelState } from './panel-state';

function bodyActions({ store, body, notices, userCalibration }: StageParts, measuring: CalibrationControl) {
  return {
    chooseEstimator(name: EstimatorName) {
      store.remember({ estimator: name });
      void body.setEstimator(name);
    },
    calibrate: () => measuring.start(),
    setMeasures({ heightCm, armSpanCm, forearmCm }: Pick<PanelState, 'heightCm' | 'armSpanCm' | 'forearmCm'>) {
      // What is measured of hands and gaze stays: no one types that.
      const { forearm, ...measured } = body.userCalibration;
      const calibration = {
        ...measured,
        eyeHeight: eyeHeightFromStature(heightCm / 100),
        armSpan: armSpanFromFingertipSpan(armSpanCm / 100),
        ...(forearmCm !== null && { forearm: forearmCm / 100 }),
      };
      const complaint = calibrationProblem(calibration);
      if (complaint) notices.show('warning', complaint, 'calibration');
      else userCalibration.calibrateForGood(calibration, 'by hand');
    },
    resetCalibration: () => userCalibration.resetCalibration(),
  };
}

function avatarActions({ writer, avatar }: StageParts, files: FileOpener) {
  return {
    choosePalette(palette: string) {
      writer.keep({ palette });
      avatar.recolour();
    },
    chooseBuiltInBody(builtInBody: BuiltInBody) {
      writer.keep({ builtInBody });
      files.showBuiltInAvatar();
    },
    /** Undefined: that of the body's file. */
    chooseSkinTone(skinTone: SkinTone | undefined) {
      writer.keep({ skinTone });
      files.showBuiltInAvatar();
    },
    openAvatarFile: (file: File) => void files.open(file),
    openAvatarUrl: (url: string) => void files.openAvatar(url),
    showBuiltInAvatar: () => files.showBuiltInAvatar(),
    cancelAvatar: () => avatar.cancel(),
    /** Opens the form for the bones of the shown file. */
    correctBones: () => void avatar.correctBones(),
    /** Sets which bone of the file that waits is which; null: forgets the user's map. */
    applyBones: (bones: BoneMap | null) => void files.applyBones(bones),
  };
}

function recordingActions(parts: StageParts, files: FileOpener, motionExport: MotionExport) {
  const { writer, settings, recorder, headset, timing, body, onChange } = parts;
  return {
    record() {
      const driven = headset.emulator || !headset.worn ? 'emulated headset' : 'headset';
      recorder.record({
        device: !headset.worn && (settings.actor || !headset.emulator) ? 'actor' : driven,
        rateHz: timing.summary().rateHz,
        calibration: body.userCalibration,
      });
      onChange();
    },
    stop() {
      recorder.stop();
      onChange();
    },
    replay: () => files.replay(),
    download() {
      const file = recorder.file();
      if (file) offerDownload(file.name, 'application/json', file.text);
    },
    exportMotion: (choice: ExportChoice) => void motionExport.begin(choice),
    cancelExport: () => motionExport.cancel(),
    /** Opens recordings, or the files of one motion. */
    openFiles: (chosen: readonly File[]) => files.openAll(chosen),
    /** Opens files that were chosen as motion capture, of a body that moves its motion. */
    openMotion: (chosen: readonly File[]) => files.openAll(chosen, { asMotion: true }),
    seek(seconds: number) {
      recorder.seek(seconds);
      body.discontinuity();
      onChange();
    },
    setPaused(on: boolean) {
      recorder.setPaused(on);
      onChange();
    },
    setLoop(on: boolean) {
      recorder.setLoop(on);
      onChange();
    },
    setActor: (on: boolean) => headset.setActor(on),
    setEmulatorPanel(on: boolean) {
      void headset.emulator?.setPanelVisible(on);
      writer.change({ emulatorPanel: on });
    },
  };
}

export function createPanelActions(
  parts: StageParts,
  measuring: CalibrationControl,
  files: FileOpener,
  motionExport: MotionExport,
) {
  const { writer, stage, userCalibration, headset, onChange } = parts;
  return {
    ...bodyActions(parts, measuring),
    ...avatarActions(parts, files),
    ...recordingActions(parts, files, motionExport),
    grip: new GripControl(parts),
    change: (part: Partial<Settings>) => writer.change(part),
    keep: (part: StoredSettings) => writer.keep(part),
    chooseView(name: ViewName) {
      stage.view.setView(name);
      onChange();
    },
    recentre: () => userCalibration.recentre(),
    exitVr: () => headset.exit(),
  };
}

/** What the controls can do, on the desktop and in the headset. */
export type PanelActions = ReturnType<typeof createPanelActions>;

/** What every page of the panel shows and acts on; what happens is decided elsewhere. */
export interface PanelPageProps {
  readonly state: PanelState;
  readonly actions: PanelActions;
}
