import type { Pointer, TrackingFrame } from 'threepoint/core';
import type { FrameReport } from 'threepoint-ui';
import type { VrPointers } from 'threepoint-ui/vr';
import type { ActivityMenu, MenuSheet } from '../../activity/activity-menu';
import type { CalibrationControl } from '../input/calibration-control';
import type { InputParts } from '../input/input-parts';
import { UserHeight } from '../input/user-height';
import type { StageParts } from '../stage/stage-parts';
import type { PanelActions } from './panel-actions';
import { type ComfortActions, comfortSheet } from './vr-menu/comfort-sheet';
import { GazeOffer } from './vr-menu/gaze-offer';
import { gripSheet } from './vr-menu/grip-sheet';
import type { VrMenuActions, VrMenuState } from './vr-menu/menu-buttons';
import { VrMenu } from './vr-menu/vr-menu';
import { WristButtons } from './vr-menu/wrist-buttons';

/** The scale of the menu in the headset for a user who wants larger text. */
const largerMenu = 1.3;

const isGaze = ({ source }: Pointer): boolean => source === 'gaze';
const isNoGaze = (pointer: Pointer): boolean => !isGaze(pointer);

/** What can be pressed in the headset: the menu, or a study's sheet in its place, and the sheets of a game. */
export class HeadsetControls {
  readonly #parts: InputParts;
  readonly #measuring: CalibrationControl;
  readonly #actions: PanelActions;
  readonly #rays: VrPointers;
  readonly #menu: VrMenu;
  readonly #wrists = new WristButtons();
  readonly #offer = new GazeOffer();
  readonly #comfort: UserHeight;
  readonly #gazes: Pointer[] = [];
  readonly #others: Pointer[] = [];
  /** The shell's own page in place of the menu; null: the menu itself. */
  #open: 'comfort' | 'grip' | null = null;
  #worn = false;

  constructor(parts: InputParts, measuring: CalibrationControl, actions: PanelActions, rays: VrPointers) {
    this.#parts = parts;
    this.#measuring = measuring;
    this.#actions = actions;
    this.#rays = rays;
    this.#menu = new VrMenu(this.#menuActions());
    this.#comfort = new UserHeight(parts);
    rays.objects.visible = false;
  }

  get objects() {
    return [this.#menu.object, this.#rays.objects, this.#wrists.object, this.#offer.object] as const;
  }

  /** The headset is on, or off again. A study's sheet takes the place of the menu. */
  setWorn(worn: boolean): void {
    this.#worn = worn;
    this.#rays.objects.visible = worn;
    this.#open = null;
    this.#comfort.reset();
    this.#menu.sendBack();
    this.#wrists.hide();
    this.#offer.hide();
    this.#showMenu();
  }

  get isPointedAt(): boolean {
    return this.#menu.isPointedAt;
  }

  #showMenu(): void {
    this.#menu.setVisible(this.#worn && this.#parts.study.run === null);
  }

  show(): void {
    this.#showMenu();
    this.#menu.object.scale.setScalar(this.#parts.settings.largerText ? largerMenu : 1);
    this.#menu.show(menuStateOf(this.#parts, this.#measuring, this.#sheet()));
  }

  showReport(report: FrameReport): void {
    this.#menu.showReport(report);
  }

  /**
   * Lets the pointers act: on the study or the menu first, then on the sheets of a game. `frame`: null if the head is
   * not seen.
   */
  point(frame: TrackingFrame | null): void {
    const { study, pointers } = this.#parts;
    if (frame) this.#comfort.observe(frame);
    const offers = pointers.offersGaze && frame !== null && study.run === null;
    if (!offers) this.#offer.hide();
    else if (this.#offer.follow(frame.head, this.#only(isGaze, this.#gazes))) this.#parts.writer.change({ gaze: true });
    // A gaze that was not accepted yet presses nothing else.
    const acting = pointers.offersGaze ? this.#only(isNoGaze, this.#others) : pointers.all;
    if (study.run) study.run.point(acting);
    else this.#pointAtPage(frame, acting);
    this.#rays.show(pointers.offersGaze && !offers ? acting : pointers.all);
  }

  #only(isOne: (pointer: Pointer) => boolean, out: Pointer[]): readonly Pointer[] {
    out.length = 0;
    for (const pointer of this.#parts.pointers.all) if (isOne(pointer)) out.push(pointer);
    return out;
  }

  #pointAtPage(frame: TrackingFrame | null, pointers: readonly Pointer[]): void {
    if (frame) {
      const pressed = this.#wrists.follow(frame, pointers);
      const asked = this.#parts.headset.commands?.menu.take() ?? false;
      if (pressed || asked) this.#callMenu(frame);
    }
    this.#menu.point(pointers);
    // One hand's ray is lit, that of a hand that presses first; the other's would put the light out again.
    if (!this.#pointAtSheets(pointers, true)) this.#pointAtSheets(pointers, false);
  }

  /** Brings the menu before the user, or puts it back. */
  #callMenu({ head }: TrackingFrame): void {
    if (this.#menu.isBrought) this.#menu.sendBack();
    else this.#menu.bring(head);
  }

  /** Points the first pointer that meets a sheet of the game at it, of those that press or do not; none: false. */
  #pointAtSheets(pointers: readonly Pointer[], pressing: boolean): boolean {
    const { current } = this.#parts.activities;
    if (!current?.point) return false;
    for (const pointer of pointers) {
      if (pointer.pressed !== pressing) continue;
      const hit = current.point(pointer, pressing && pointer.pointedAt?.owner !== 'menu');
      if (hit === null) continue;
      pointer.pointAt(hit);
      return true;
    }
    return false;
  }

  #sheet(): MenuSheet | null {
    if (this.#open === null) return null;
    return this.#open === 'comfort' ? this.#comfortSheet() : this.#gripSheet();
  }

  /** Null: the user holds no controller. */
  #gripSheet(): MenuSheet | null {
    const { grip } = this.#actions;
    return grip.state && gripSheet(grip.state, grip, () => this.#openSheet(null));
  }

  #comfortSheet() {
    const { settings, headset } = this.#parts;
    const { gaze, sound, largerText } = settings;
    const moves = headset.passthrough === null;
    const { seated } = this.#comfort;
    return comfortSheet({ moves, raised: headset.raised, seated, gaze, sound, largerText }, this.#comfortActions());
  }

  #comfortActions(): ComfortActions {
    const { headset, writer, activities } = this.#parts;
    const comfort = this.#comfort;
    return {
      turn: (direction) => headset.commands?.turn(direction),
      setSeated: (on) => this.#change(() => comfort.setSeated(on)),
      raiseBy: (metres) => this.#change(() => comfort.raiseBy(metres)),
      setGaze: (gaze) => writer.keep({ gaze }),
      setSound: (on) => activities.setSound(on),
      setLargerText: (largerText) => writer.keep({ largerText }),
      close: () => this.#openSheet(null),
    };
  }

  #openSheet(sheet: 'comfort' | 'grip' | null): void {
    this.#change(() => {
      this.#open = sheet;
    });
  }

  /** Shows the effect of a press at once. */
  #change(act: () => void): void {
    act();
    this.show();
  }

  #menuActions(): VrMenuActions {
    const { activities, writer } = this.#parts;
    const [actions, measuring] = [this.#actions, this.#measuring];
    return {
      chooseEstimator: (name) => actions.chooseEstimator(name),
      calibrate: () => measuring.begin(),
      cancelCalibration: () => measuring.cancel(),
      recentre: () => this.#comfort.recentre(),
      openComfort: () => this.#openSheet('comfort'),
      openGrip: () => this.#openSheet('grip'),
      setOverlay: (on) => writer.change({ vrOverlay: on }),
      setPassthrough: (passthrough) => writer.keep({ passthrough }),
      setBeside: (beside) => writer.change({ beside }),
      goTo: (place) => {
        this.#menu.sendBack();
        void activities.goTo(place);
      },
      chooseBuiltInBody: (name) => actions.chooseBuiltInBody(name),
      chooseSkinTone: (tone) => actions.chooseSkinTone(tone),
      exit: () => actions.exitVr(),
    };
  }
}

/** The menu of an activity that has none. */
const noMenu: ActivityMenu = { entries: [], sheet: null, notice: null, hint: null };

/** Returns the current state of the menu in the headset. `sheet`: the shell's own page in place of it; null: none. */
export function menuStateOf(
  { body, settings, activities, notices, headset }: StageParts,
  measuring: CalibrationControl,
  sheet: MenuSheet | null,
): VrMenuState {
  const activity = activities.current && (activities.current.menu?.() ?? noMenu);
  return {
    estimator: body.estimator,
    unavailable: body.unavailableEstimators,
    calibration: measuring.step,
    overlay: settings.vrOverlay,
    deviceBody: settings.deviceBody,
    nextPassthrough: headset.passthroughOffered ? settings.passthrough : null,
    beside: headset.passthrough ? settings.beside : null,
    inPassthrough: headset.passthrough !== null,
    builtInBody: settings.builtInBody,
    skinTone: settings.skinTone,
    holdsControllers: Object.keys(headset.heldDevices ?? {}).length > 0,
    places: activities.all.map(({ name, title }) => ({ name, title })),
    activity,
    sheet: sheet ?? activity?.sheet ?? null,
    notice: activity?.notice ?? notices.current().at(-1)?.text ?? activity?.hint ?? null,
  };
}
