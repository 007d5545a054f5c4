import type { BodySolver } from 'threepoint/api/body-solver';
import { linkTo } from 'threepoint-ui/invitation';
import type { FrameReport } from 'threepoint-ui/overlay';
import { qrCode } from 'threepoint-ui/qr-code';
import type { VrPointers } from 'threepoint-ui/vr-pointers';
import { otherPlayers } from '../../ball/other-players';
import { consentText, type VoicesState } from '../../ball/voices-state';
import type { Activities } from '../activities';
import type { PanelActions } from '../panel/panel';
import type { ShownInvitation, VrMenuActions, VrMenuState } from '../vr-menu/menu-buttons';
import { VrMenu } from '../vr-menu/vr-menu';
import type { ControlledParts } from './controlled-parts';
import type { Measuring } from './measuring';

const noVoices: VoicesState = { phase: 'none', muted: true, relay: false, relayOnly: false, said: null, deaf: false };
/** How much larger the menu in the headset is for a user who wants larger text. */
const largerMenu = 1.3;

export interface HeadsetControlsOptions
  extends Pick<ControlledParts, 'switches' | 'settings' | 'writer' | 'notices' | 'study'> {
  readonly server: Pick<ControlledParts['server'], 'state'>;
  readonly pointers: VrPointers;
  readonly body: Pick<BodySolver, 'estimator' | 'unavailable'>;
  readonly activities: Pick<Activities, 'name' | 'archery' | 'ball' | 'goTo' | 'rule' | 'restartRound' | 'point'>;
  readonly measuring: Pick<Measuring, 'step' | 'begin' | 'cancel'>;
  readonly actions: Pick<
    PanelActions,
    'chooseEstimator' | 'chooseOwnBody' | 'chooseSkinTone' | 'setPlainOthers' | 'recentre' | 'exitVr'
  >;
}

/** What can be pressed in the headset: the menu, or a study's sheet in its place, and the sheets of a game. */
export class HeadsetControls {
  readonly #options: HeadsetControlsOptions;
  readonly #menu: VrMenu;
  /** What others need to come, while it is held up for them. */
  #invitation: ShownInvitation | null = null;
  /** Who else is here is held up. */
  #listed = false;
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
    this.#invitation = null;
    this.#listed = false;
    this.#worn = worn;
    this.#options.pointers.objects.visible = worn;
    this.#showMenu();
  }

  #showMenu(): void {
    this.#menu.setVisible(this.#worn && this.#options.study.run === null);
  }

  show(): void {
    this.#showMenu();
    this.#menu.object.scale.setScalar(this.#options.settings.largerText ? largerMenu : 1);
    this.#menu.show(this.#state());
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
      const distance = activities.point({ origin: { ...origin }, direction: { ...direction } }, pressed);
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
      goTo: (activity) => void activities.goTo(activity),
      chooseOwnBody: (name) => actions.chooseOwnBody(name),
      chooseSkinTone: (tone) => actions.chooseSkinTone(tone),
      setPlainOthers: (on) => actions.setPlainOthers(on),
      setBowSide: (side) => activities.rule({ bowSide: side }),
      restart: () => activities.restartRound(),
      ready: (on) => activities.ball?.play.ready(on),
      askVoices: (on) => activities.ball?.voices.ask(on),
      joinVoices: () => void activities.ball?.voices.join(),
      mute: (on) => void activities.ball?.voices.setMuted(on),
      listOthers: (on) =>
        this.#pressed(() => {
          this.#listed = on;
        }),
      silence: (seat, on) => this.#pressed(() => activities.ball?.voices.silence(seat, on)),
      hide: (seat, on) => this.#pressed(() => activities.ball?.voices.hide(seat, on)),
      invite: (on) => this.#invite(on),
      exit: () => actions.exitVr(),
    };
  }

  #state(): VrMenuState {
    const { body, settings, activities, measuring } = this.#options;
    return {
      estimator: body.estimator,
      unavailable: body.unavailable,
      calibration: measuring.step,
      overlay: settings.vrOverlay,
      deviceBody: settings.deviceBody,
      activity: activities.name,
      ownBody: settings.ownBody,
      skinTone: settings.skinTone,
      plainOthers: settings.plainOthers,
      bowSide: settings.bowSide,
      roundOver: activities.archery?.round()?.over ?? false,
      ...this.#ballState(),
    };
  }

  /** The room that others can come into; null: there is none. */
  #openRoom(): string | null {
    const { switches, server, activities } = this.#options;
    return activities.ball && server.state !== 'none' ? switches.room : null;
  }

  /** What a press has changed is seen at once, not with the next look at the round. */
  #pressed(act: () => void): void {
    act();
    this.show();
  }

  #invite(on: boolean): void {
    const room = on ? this.#openRoom() : null;
    if (room === null) this.#holdUp(null);
    else {
      const link = linkTo(room);
      this.#holdUp({ ...link, code: 'loading' });
      const bring = (code: ShownInvitation['code']) => {
        if (this.#invitation?.code === 'loading') this.#holdUp({ ...link, code });
      };
      qrCode(link.address).then(bring, () => bring('not to be had'));
    }
  }

  #holdUp(invitation: ShownInvitation | null): void {
    this.#invitation = invitation;
    this.show();
  }

  #ballState(): Pick<VrMenuState, 'ready' | 'voices' | 'others' | 'listed' | 'canInvite' | 'invitation' | 'notice'> {
    const { activities, notices } = this.#options;
    const { ball } = activities;
    const round = ball?.round() ?? null;
    const canInvite = this.#openRoom() !== null;
    const { phase, muted, deaf, said } = ball?.voices.state ?? noVoices;
    const asked = round !== null && round.ended === null && round.seat !== null && round.phase !== 'running';
    return {
      ready: asked ? round.ready : null,
      voices: { phase, muted, deaf },
      others: round ? otherPlayers(round, phase === 'in') : [],
      listed: round !== null && this.#listed,
      canInvite,
      // What is held up in the court goes when one leaves it.
      invitation: canInvite ? this.#invitation : null,
      notice:
        (phase === 'asked' ? consentText : said) ??
        ball?.banner() ??
        notices.current().at(-1)?.text ??
        round?.waiting ??
        round?.connection ??
        null,
    };
  }
}
