import { render } from 'preact';
import type { TrackingFrame } from 'threepoint/core';
import { CalibrationDialog, type CalibrationStep, type FrameReport, FrameTimes, pageElement } from 'threepoint-ui';
import { createVrPointers } from 'threepoint-ui/vr';
import { CalibrationControl } from '../input/calibration-control';
import { acceptDroppedFiles, FileOpener } from '../input/file-opener';
import type { InputParts } from '../input/input-parts';
import { estimatorTexts } from '../session/estimator-texts';
import { stageNames } from '../session/frame-timing';
import { DesktopControls } from './desktop-controls';
import { HeadsetControls } from './headset-controls';
import { MotionExport } from './motion-export';
import { createPanelActions } from './panel-actions';
import { createPlayBar, type PlayBar } from './play-bar';
import { isNarrow, WindowLayout } from './window-layout';

/** The interval between two reports of the frame times [ms]. */
const reportEveryMs = 250;

/**
 * Everything a person can press, read or type, on the desktop and in the headset; it keeps no state of the page's own.
 */
export class Controls {
  readonly #parts: InputParts;
  readonly #measuring: CalibrationControl;
  readonly #files: FileOpener;
  readonly #play: PlayBar;
  readonly #desktop: DesktopControls;
  readonly #inHeadset: HeadsetControls;
  readonly #layout: WindowLayout;
  readonly #overlay = pageElement('overlay', HTMLElement);
  readonly #dialog = document.body.appendChild(document.createElement('div'));
  /** Whether the panel was open when the headset was put on. */
  #panelOpenBefore = false;

  constructor(parts: InputParts) {
    const { stage } = parts;
    const panelRegion = pageElement('controls', HTMLElement);
    this.#parts = parts;
    this.#measuring = new CalibrationControl(parts);
    this.#files = new FileOpener(parts);
    this.#play = createPlayBar(parts.activities);
    const measuring = this.#measuring;
    const motionExport = new MotionExport(parts);
    const actions = createPanelActions(parts, measuring, this.#files, motionExport);
    this.#desktop = new DesktopControls(panelRegion, parts, actions, motionExport);
    this.#inHeadset = new HeadsetControls(parts, measuring, actions, createVrPointers());
    this.#layout = new WindowLayout(parts, panelRegion, () => this.#desktop.panelOpen);
    stage.studio.scene.add(...this.#inHeadset.objects);
    measuring.steps.listen((step) => {
      this.#inHeadset.show();
      this.#showCalibration(step);
    });
    acceptDroppedFiles((files) => this.#files.openAll(files));
    setInterval(() => this.#report(), reportEveryMs);
  }

  /** Updates everything on the screen to the state of the page. */
  show(): void {
    const { settings, headset, activities, stage, avatar } = this.#parts;
    document.body.classList.toggle('larger-text', settings.largerText);
    document.body.classList.toggle('in-session', headset.worn);
    document.body.classList.toggle('in-activity', activities.current !== null);
    document.body.classList.toggle('prefers-ar', settings.passthrough);
    this.#overlay.hidden = !settings.overlay;
    stage.setSkeletonVisible(settings.debugSkeleton);
    avatar.current?.setUpperBodyOnly(settings.upperBodyOnly);
    this.#desktop.show();
    this.#play.show();
    this.#layout.arrange();
    this.#inHeadset.show();
  }

  /** The headset was put on or taken off: shows the menu and hides the panel, or the reverse. */
  setWorn(worn: boolean): void {
    this.#inHeadset.setWorn(worn);
    if (worn) this.#panelOpenBefore = this.#desktop.panelOpen;
    else this.#measuring.cancel();
    this.#desktop.setPanelOpen(!worn && this.#panelOpenBefore);
  }

  /**
   * Opens or closes the panel. If there is no place beside the picture it stays closed until its button is pressed,
   * unless the address asks for it.
   */
  setPanelOpen(open: boolean): void {
    const asked = this.#parts.switches.panel === true;
    this.#desktop.setPanelOpen(open && (asked || !isNarrow()));
  }

  caption(text: string): void {
    this.#play.caption(text);
  }

  layOut(): void {
    this.#layout.layOut();
  }

  observe(frame: TrackingFrame): void {
    this.#measuring.observe(frame);
  }

  /** A hand points at the menu in the headset. */
  get isPointedAt(): boolean {
    return this.#inHeadset.isPointedAt;
  }

  /** Rays and finger tips in the headset. `frame`: null if the head is not tracked. */
  point(frame: TrackingFrame | null): void {
    this.#inHeadset.point(frame);
  }

  /** Shows the avatar of the last visit, if the user opened a file then. */
  openStoredAvatar(): Promise<void> {
    return this.#files.openStoredAvatar();
  }

  /** Replays a file of this device or of an address. `requestNumber`: its number among the recorder's requests. */
  openRecording(source: string | File, requestNumber: number): Promise<void> {
    return this.#files.openRecording(source, requestNumber);
  }

  /** Shows a step of the guided calibration at the desk; null: it is over. */
  #showCalibration(step: CalibrationStep | null): void {
    const measuring = this.#measuring;
    const isShown = step !== null && !this.#parts.headset.worn;
    render(
      isShown && <CalibrationDialog step={step} cancel={() => measuring.cancel()} again={() => measuring.start()} />,
      this.#dialog,
    );
  }

  /** What changes by itself: frame times, a replay's progress, a round. */
  #report(): void {
    const { recorder, activities, mocap, settings } = this.#parts;
    const report = this.#frameReport();
    if (settings.overlay) render(<FrameTimes report={report} />, this.#overlay);
    this.#inHeadset.showReport(report);
    mocap.show();
    if (recorder.mode !== 'idle') this.show();
    else if (activities.current) this.#play.show();
    if (activities.current) this.#inHeadset.show();
    this.#play.showBanner();
    this.#layout.arrange();
  }

  /** What frames cost over the last seconds, and what estimates the body in them. */
  #frameReport(): FrameReport {
    const { timing, body, difference } = this.#parts;
    const summary = timing.summary();
    return {
      ...summary,
      stages: stageNames.map((name) => ({ name, ...summary.stages[name] })),
      estimator: estimatorTexts[body.estimator].label,
      provider: body.provider ?? 'no network',
      fromDevice: difference.report(),
    };
  }
}
