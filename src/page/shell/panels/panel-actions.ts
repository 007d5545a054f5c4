import { armSpanFromFingertipSpan, calibrationProblem, eyeHeightFromStature } from 'threepoint/core';
import { offerDownload } from 'threepoint-ui';
import type { CalibrationControl } from '../input/calibration-control';
import type { FileOpener } from '../input/file-opener';
import type { StageParts } from '../stage/stage-parts';
import type { MotionExport } from './motion-export';
import type { PanelActions } from './panel';
import type { AvatarActions, BodyActions, RecordingActions, SettingActions } from './panel-state';

function bodyActions(
  { store, body, notices, userCalibration }: StageParts,
  measuring: CalibrationControl,
): Omit<BodyActions, keyof SettingActions> {
  return {
    chooseEstimator(name) {
      store.remember({ estimator: name });
      void body.setEstimator(name);
    },
    calibrate: () => measuring.start(),
    setMeasures({ heightCm, armSpanCm, forearmCm }) {
      // What is measured of hands and gaze stays: no one types that.
      const { forearm, ...measured } = body.userCalibration;
      const calibration = {
        ...measured,
        eyeHeight: eyeHeightFromStature(heightCm / 100),
        armSpan: armSpanFromFingertipSpan(armSpanCm / 100),
        ...(forearmCm !== null && { forearm: forearmCm / 100 }),
      };
      const complaint = calibrationProblem(calibration);
      if (complaint) notices.show('warning', complaint);
      else userCalibration.calibrateForGood(calibration, 'by hand');
    },
    resetCalibration: () => userCalibration.resetCalibration(),
  };
}

function avatarActions({ writer, avatar }: StageParts, files: FileOpener): Omit<AvatarActions, keyof SettingActions> {
  return {
    choosePalette(palette) {
      writer.keep({ palette });
      avatar.recolour();
    },
    chooseBuiltInBody(builtInBody) {
      writer.keep({ builtInBody });
      files.showBuiltInAvatar();
    },
    chooseSkinTone(skinTone) {
      writer.keep({ skinTone });
      files.showBuiltInAvatar();
    },
    openAvatarFile: (file) => void files.open(file),
    openAvatarUrl: (url) => void files.openAvatar(url),
    showBuiltInAvatar: () => files.showBuiltInAvatar(),
    cancelAvatar: () => avatar.cancel(),
    correctBones: () => void avatar.correctBones(),
    applyBones: (bones) => void files.applyBones(bones),
  };
}

function recordingActions(parts: StageParts, files: FileOpener, motionExport: MotionExport): RecordingActions {
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
    exportMotion: (choice) => void motionExport.begin(choice),
    cancelExport: () => motionExport.cancel(),
    openFiles: (chosen) => files.openAll(chosen),
    openMotion: (chosen) => files.openAll(chosen, { asMotion: true }),
    seek(seconds) {
      recorder.seek(seconds);
      body.discontinuity();
      onChange();
    },
    setPaused(on) {
      recorder.setPaused(on);
      onChange();
    },
    setLoop(on) {
      recorder.setLoop(on);
      onChange();
    },
    setActor(on) {
      writer.change({ actor: on });
      body.discontinuity();
      // Without the actor a person must hold the headset: a real one, or the emulated one.
      if (!on) void headset.ensureEmulator().then((emulator) => emulator?.release());
    },
    setEmulatorPanel(on) {
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
): PanelActions {
  const { writer, stage, userCalibration, headset, onChange } = parts;
  return {
    ...bodyActions(parts, measuring),
    ...avatarActions(parts, files),
    ...recordingActions(parts, files, motionExport),
    change: (part) => writer.change(part),
    keep: (part) => writer.keep(part),
    chooseView(name) {
      stage.view.setView(name);
      onChange();
    },
    recentre: () => userCalibration.recentre(),
    exitVr: () => headset.exit(),
  };
}
