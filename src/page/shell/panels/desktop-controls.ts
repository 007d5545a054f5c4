import {
  armSpanRange,
  fingertipSpanFromArmSpan,
  forearmRange,
  statureFromEyeHeight,
  statureRange,
} from 'threepoint/core';
import { palettes } from 'threepoint/three';
import { listenToShortcuts, type Shortcuts } from 'threepoint-ui';
import { viewNames } from '../../scene/desktop-view';
import type { InputParts } from '../input/input-parts';
import { estimatorOrder } from '../session/estimator-texts';
import type { MotionExport } from './motion-export';
import { createPanel, type Panel } from './panel';
import type { PanelActions } from './panel-actions';
import type { PanelState } from './panel-state';

const centimetres = (metres: number): number => 100 * metres;

/** The panel and the keys of the desktop page. */
export class DesktopControls {
  readonly #parts: InputParts;
  readonly #actions: PanelActions;
  readonly #motionExport: MotionExport;
  readonly #panel: Panel;

  constructor(region: HTMLElement, parts: InputParts, actions: PanelActions, motionExport: MotionExport) {
    const { headset, settings, study } = parts;
    this.#parts = parts;
    this.#actions = actions;
    this.#motionExport = motionExport;
    this.#panel = createPanel(
      region,
      {
        height: { min: centimetres(statureRange.min), max: centimetres(statureRange.max) },
        armSpan: {
          min: centimetres(fingertipSpanFromArmSpan(armSpanRange.min)),
          max: centimetres(fingertipSpanFromArmSpan(armSpanRange.max)),
        },
        forearm: { min: centimetres(forearmRange.min), max: centimetres(forearmRange.max) },
      },
      palettes,
      actions,
    );
    listenToShortcuts(this.#shortcuts(), () => settings.singleKeys && !headset.worn && study.run === null);
  }

  get panelOpen(): boolean {
    return this.#panel.open;
  }

  setPanelOpen(open: boolean): void {
    this.#panel.setOpen(open);
  }

  show(): void {
    this.#panel.show(this.#state());
  }

  #shortcuts(): Shortcuts {
    const { settings, stage, activities } = this.#parts;
    const actions = this.#actions;
    const nextView = () => viewNames[(viewNames.indexOf(stage.view.view) + 1) % viewNames.length] ?? 'front';
    const estimators = estimatorOrder.map((name, index) => [String(index + 1), () => actions.chooseEstimator(name)]);
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
      p: () => this.#panel.toggle(),
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
