import { render } from 'preact';
import { fingertipSpanFromArmSpan, statureFromEyeHeight } from 'threepoint/core';
import { listenToShortcuts, type Shortcuts } from 'threepoint-ui';
import { viewNames } from '../../scene/desktop-view';
import type { InputParts } from '../input/input-parts';
import { listedEstimators } from '../session/estimator-texts';
import type { MotionExport } from './motion-export';
import { Panel } from './panel';
import type { PanelActions } from './panel-actions';
import type { PanelState } from './panel-state';

const centimetres = (metres: number): number => 100 * metres;

/** The panel and the keys of the desktop page. */
export class DesktopControls {
  readonly #region: HTMLElement;
  readonly #parts: InputParts;
  readonly #actions: PanelActions;
  readonly #motionExport: MotionExport;
  #open = true;

  constructor(region: HTMLElement, parts: InputParts, actions: PanelActions, motionExport: MotionExport) {
    const { headset, settings, study } = parts;
    this.#region = region;
    this.#parts = parts;
    this.#actions = actions;
    this.#motionExport = motionExport;
    listenToShortcuts(this.#shortcuts(), () => settings.singleKeys && !headset.worn && study.run === null);
  }

  get panelOpen(): boolean {
    return this.#open;
  }

  /** Opens or closes the panel. Its region emits the event `toggle`. */
  setPanelOpen(open: boolean): void {
    this.#open = open;
    this.#region.classList.toggle('closed', !open);
    this.show();
    this.#region.dispatchEvent(new Event('toggle'));
  }

  show(): void {
    const toggle = () => this.#toggle();
    // A study hides the controls: its participant cannot close them by Esc.
    const open = this.#open && this.#parts.study.run === null;
    render(<Panel state={this.#state()} actions={this.#actions} open={open} toggle={toggle} />, this.#region);
  }

  /** Opens or closes the panel for the user, also on later visits. */
  #toggle(): void {
    this.setPanelOpen(!this.#open);
    this.#actions.keep({ panel: this.#open });
  }

  #shortcuts(): Shortcuts {
    const { settings, stage, activities } = this.#parts;
    const actions = this.#actions;
    const nextView = () => viewNames[(viewNames.indexOf(stage.view.view) + 1) % viewNames.length] ?? 'front';
    const estimators = listedEstimators.map((name, index) => [String(index + 1), () => actions.chooseEstimator(name)]);
    return {
      ...Object.fromEntries(estimators),
      v: () => actions.chooseView(nextView()),
      c: () => actions.calibrate(),
      r: () => actions.recentre(),
      m: () => actions.keep({ mirror: !settings.mirror }),
      b: () => actions.change({ debugSkeleton: !settings.debugSkeleton }),
      u: () => actions.keep({ upperBodyOnly: !settings.upperBodyOnly }),
      o: () => actions.keep({ overlay: !settings.overlay }),
      t: () => activities.current?.toggleMuted?.(),
      p: () => this.#toggle(),
    };
  }

  #state(): PanelState {
    const { settings, body, stage, avatar, headset, recorder } = this.#parts;
    const { eyeHeight, armSpan, forearm } = body.userCalibration;
    return {
      ...settings,
      estimator: body.selectedEstimator,
      unavailable: body.unavailableEstimators,
      view: stage.view.view,
      avatarName: avatar.current ? avatar.name : 'None yet',
      avatarPending: avatar.pending,
      avatarOnItsWay: avatar.isLoading,
      canCorrectBones: avatar.canCorrectBones,
      waitingForBones: avatar.waiting,
      builtInAvatarOffered: !avatar.isBuiltIn || avatar.pending !== null || avatar.current === null,
      builtInBody: avatar.builtInBody,
      palette: avatar.isBuiltIn ? settings.palette : null,
      heightCm: centimetres(statureFromEyeHeight(eyeHeight)),
      armSpanCm: centimetres(fingertipSpanFromArmSpan(armSpan)),
      forearmCm: forearm === undefined ? null : centimetres(forearm),
      eyeHeightCm: centimetres(eyeHeight),
      grip: this.#actions.grip.state,
      emulated: headset.emulator !== null,
      inSession: headset.worn,
      inPassthrough: headset.passthrough !== null,
      rateHz: headset.worn ? headset.rateHz : null,
      ratesHz: headset.ratesHz,
      bodyComplaint: headset.bodyComplaint,
      recorder,
      exporting: this.#motionExport.state,
    };
  }
}
