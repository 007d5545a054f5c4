import type { BodySolver } from 'threepoint/api/body-solver';
import type { FrameReport } from 'threepoint-ui/overlay';
import type { VrPointers } from 'threepoint-ui/vr-pointers';
import type { Activities } from '../activities';
import type { Headset } from '../headset';
import type { PanelActions } from '../panel/panel';
import type { VrMenuActions } from '../vr-menu/menu-buttons';
import { menuStateOf } from '../vr-menu/menu-state';
import { VrMenu } from '../vr-menu/vr-menu';
import type { ControlledParts } from './controlled-parts';
import type { Measuring } from './measuring';

/** The scale of the menu in the headset for a user who wants larger text. */
const largerMenu = 1.3;

export interface HeadsetControlsOptions extends Pick<ControlledParts, 'settings' | 'writer' | 'notices' | 'study'> {
  readonly pointers: VrPointers;
  readonly body: Pick<BodySolver, 'estimator' | 'unavailable'>;
  readonly activities: Pick<Activities, 'all' | 'current' | 'goTo'>;
  readonly headset: Pick<Headset, 'passthrough' | 'passthroughOffered'>;
  readonly measuring: Pick<Measuring, 'step' | 'begin' | 'cancel'>;
  readonly actions: Pick<
    PanelActions,
    'chooseEstimator' | 'chooseBuiltInBody' | 'chooseSkinTone' | 'recentre' | 'exitVr'
  >;
}

/** What can be pressed in the headset: the menu, or a study's sheet in its place, and the sheets of a game. */
export class HeadsetControls {
  readonly #options: HeadsetControlsOptions;
  readonly #menu: VrMenu;
  #worn = false;

  constructor(options: HeadsetControlsOptions) {
    this.#options = options;
    this.#menu = new VrMenu(this.#menuActions());
    options.pointers.objects.visible = false;
  }

  /** For the scene. */
  get objects() {
    return [this.#menu.object, this.#options.pointers.objects] as const;
  }

  /** The headset is on, or off again. A study's sheet takes the place of the menu. */
  setWorn(worn: boolean): void {
    this.#worn = worn;
    this.#options.pointers.objects.visible = worn;
    this.#showMenu();
  }

  get isPointedAt(): boolean {
    return this.#menu.isPointedAt;
  }

  #showMenu(): void {
    this.#menu.setVisible(this.#worn && this.#options.study.run === null);
  }

  show(): void {
    this.#showMenu();
    this.#menu.object.scale.setScalar(this.#options.settings.largerText ? largerMenu : 1);
    this.#menu.show(menuStateOf(this.#options));
  }

  showReport(report: FrameReport): void {
    this.#menu.showReport(report);
  }

  /** Rays and finger tips: the study or the menu first, then the sheets of a game. */
  point(): void {
    const { study, pointers, activities } = this.#options;
    const hands = pointers.take();
    if (study.run) {
      study.run.point(hands);
      return;
    }
    this.#menu.point(hands);
    const pressingFirst = [...hands].sort((a, b) => Number(b.pressed) - Number(a.pressed));
    for (const { origin, direction, pressed, showRay } of pressingFirst) {
      const ray = { origin: { ...origin }, direction: { ...direction } };
      const distance = activities.current?.point?.(ray, pressed) ?? null;
      if (distance === null) continue;
      showRay(distance);
      // One hand's ray is lit; the other's would put the light out again.
      break;
    }
  }

  #menuActions(): VrMenuActions {
    const { actions, activities, measuring, writer } = this.#options;
    return {
      chooseEstimator: (name) => actions.chooseEstimator(name),
      calibrate: () => measuring.begin(),
      cancelCalibration: () => measuring.cancel(),
      recentre: () => actions.recentre(),
      setOverlay: (on) => writer.change({ vrOverlay: on }),
      setPassthrough: (passthrough) => writer.keep({ passthrough }),
      setBeside: (beside) => writer.change({ beside }),
      goTo: (place) => void activities.goTo(place),
      chooseBuiltInBody: (name) => actions.chooseBuiltInBody(name),
      chooseSkinTone: (tone) => actions.chooseSkinTone(tone),
      exit: () => actions.exitVr(),
    };
  }
}
