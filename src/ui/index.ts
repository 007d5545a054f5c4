// "threepoint-ui": elements, dialogs and notices of all pages.
export type { CalibrationStep } from './calibration-dialog';
export { CalibrationDialog, calibrationHeadline, calibrationInstruction } from './calibration-dialog';
export { type CalibrationGuide, createCalibrationGuide } from './calibration-guide';
export { createEnterButton, type EnterButton } from './enter-button';
export { closeOnEscape, useEscape } from './escape';
export type { FrameReport } from './frame-times-overlay';
export { differenceLines, FrameTimes, milliseconds, missedFrames } from './frame-times-overlay';
export { linkTo, type RoomLink, RoomLinkCard, showInvitation } from './invitation';
export { type FileKind, fileNameOf, offerDownload, readLimited } from './limited-files';
export { createMouseAim, isTouchFirst, type MouseAim } from './mouse-aim';
export { createNotices, formatSentence, type Notice, type Notices } from './notices';
export { pageElement } from './page-element';
export { pageFolder } from './page-folder';
export { drawQrCode, type QrCode, qrCode } from './qr-code';
export { ServerPresence, type ServerState } from './server-presence';
export { listenToShortcuts, type Shortcuts } from './shortcuts';
export { installTrustedTypesPolicy } from './trusted-types';
