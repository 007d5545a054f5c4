import type { Holding } from 'threepoint/avatar/hands/holding';
import { createRemoteAvatars, type RemoteAvatars } from 'threepoint/avatar/remote-avatars';
import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import type { Fingers, MutableHandShape } from 'threepoint/core/body/hand-shape';
import type { OwnBody, WornAvatar } from 'threepoint/core/body/worn-avatar';
import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import type { Buttons } from 'threepoint/core/input/button-presses';
import { type Pose, type Transform, transformPoint, transformPose } from 'threepoint/core/math/pose';
import { rotate } from 'threepoint/core/math/quat';
import type { Ray } from 'threepoint/core/math/ray';
import type { Side } from 'threepoint/core/math/side';
import { type Vec3, vec3 } from 'threepoint/core/math/vec3';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import type { BallConnection } from 'threepoint-games/ball/ball-client';
import type { BallState } from 'threepoint-games/ball/ball-state';
import { ballRadius, basketRadius, rimTube } from 'threepoint-games/ball/flight';
import type { BallPulse } from 'threepoint-games/ball/gestures';
import type { PlayerInput } from 'threepoint-games/ball/player-postures';
import { defaultBallOptions } from 'threepoint-games/ball/rules';
import { ballsLeft } from 'threepoint-games/ball/state-readings';
import type { BallSteering } from 'threepoint-games/ball/steered-players';
import { ballInPalm } from 'threepoint-games/fist';
import type { AvatarExchange } from 'threepoint-rooms/client/avatar-exchange';
import { bannerText, connectionText } from 'threepoint-rooms/client/banner';
import type { Visitor } from 'threepoint-rooms/client/connection';
import type { Quality } from '../scene/renderer';
import type { SurroundingsHost } from '../scene/surroundings';
import type { BallRound } from './ball-bar';
import type { BallFrame, BallProbe } from './ball-frame';
import { type BallPlay, createBallPlay } from './ball-play';
import { type BallView, createBallView } from './ball-view';
import { type LobbyButton, nameOf, ownName, seatOfButton, waitingFor } from './board-drawing';
import { roleTexts, seatLooks } from './court-plan';
import { eventHaptics } from './haptics';
import { createMatchClock } from './match-clock';
import { type PlayerProbe, playersOf } from './player-probe';
import { SeenAvatars } from './seen-avatars';
import { type OwnWear, SharedAvatar } from './shared-avatar';
import { Voices, type VoicesOptions } from './voices';
import type { VoicesProbe } from './voices-state';

export interface BallActivityOptions {
  readonly quality: Quality;
  readonly surroundings: SurroundingsHost;
  /** The file of the body that others have. */
  readonly mannequin: ArrayBuffer;
  /** The file of another body of our own. */
  fetchOwn(name: OwnBody): Promise<ArrayBuffer>;
  readonly visitor: Visitor;
  /** The visitor's name was given by the page: its player reads “You” instead. */
  readonly unnamed: boolean;
  connect(visitor: Visitor, time: number): BallConnection;
  /** null: avatars that are files are not exchanged in this room. */
  readonly avatars: AvatarExchange | null;
  readonly voiceTerms: VoicesOptions['terms'];
  /** Voices go by a relay alone. */
  relayOnly(): boolean;
  /** What the player has on, for the others; null: they are to see the plain one. Asked for in every frame. */
  worn(): OwnWear | null;
  /** All other players are drawn as the mannequin. */
  plainOthers(): boolean;
  notify(level: 'info' | 'warning', text: string): void;
  bots(): boolean;
  acting(): boolean;
  /** What a mouse wants of the own player, floor frame; null: nothing, a built-in one plays. */
  steering(): BallSteering | null;
  readonly seed: number;
  readonly onCaption: (text: string) => void;
}

/** What tools may know of a match and of its voices. */
export type CourtProbe = BallProbe & { readonly voices: VoicesProbe };

/** The ball game in the page: the court, the others' bodies, and one's own part in the match. */
export interface BallActivity {
  readonly play: BallPlay;
  readonly sound: BallView['sound'];
  readonly voices: Voices;
  /** Once a frame, first. */
  begin(time: number): void;
  /** Head, hands and buttons of the built-in player on the own seat; null: no seat. */
  act(time: number, catchUp: boolean): PlayerInput | null;
  /** The tracked frame as play: what it means is heard at once, what it feels like comes back. */
  follow(frame: TrackingFrame, buttons: Buttons): readonly BallPulse[];
  send(frame: TrackingFrame, pose: AvatarPose, fingers: Fingers): void;
  /** Closes a hand with this wrist round the basket or a ball; false: it holds neither. */
  grasp(side: Side, wrist: Pose<'floor'>, holding: Holding, target: MutableHandShape): boolean;
  /** Draws the match; head: the eyes and ears of the viewer, own floor frame. `tracked`: whether `follow` was called for this frame. */
  show(time: number, head: Pose<'floor'>, tracked: boolean): void;
  /** What a ray meets on the sheet before and after a match: the distance [m]; null: nothing. `press`: does what it says. */
  point(ray: Ray, press: boolean): number | null;
  /** The colours of the own seat: one of the avatar's palettes; null: a spectator. */
  readonly palette: string | null;
  /** Pelvis and eyes of a player to follow, own floor frame; null: no player of this seat is drawn. */
  bodyOf(seat: number): { readonly pelvis: Vec3; readonly eyes: Pose<'floor'> } | null;
  /** Which of the others there are to follow. */
  readonly seats: readonly number[];
  round(): BallRound | null;
  /** What a person should know of the connection; null: nothing. */
  banner(): string | null;
  probe(): CourtProbe | null;
  players(): readonly PlayerProbe[];
  dispose(): void;
}

type Players = BallFrame['players'];

/** The basket's rim in the floor frame; a ball in a hand. */
const rim = { at: vec3(0, 0, 0), normal: vec3(0, 1, 0), radius: basketRadius, tube: rimTube };
const heldAt = vec3(0, 0, 0);

const noBodies: BallFrame['bodies'] = [];
const noButtons: Buttons = {
  left: { trigger: 0, grip: 0, pinch: 0 },
  right: { trigger: 0, grip: 0, pinch: 0 },
};
/** How long a notice of a voided match stands [s]. */
const noticeSeconds = 8;
const voidedNotice = 'The server was restarted: this round does not count. A new one can begin.';

const roleOf = (state: BallState, player: number): string => roleTexts[state.players[player]?.station ?? player] ?? '';

/** The seats of a match as the bar lists them. */
const placesOf = (state: BallState, players: Players, voices: Voices): BallRound['people'] =>
  players.map((player, seat) => ({
    seat,
    name: player && (player.me ? player.name : nameOf(player)),
    role: roleOf(state, seat),
    free: player === null || (player.bot && !player.me),
    ...voices.voiceOf(seat),
  }));

export const createBallActivity = (options: BallActivityOptions): BallActivity => new CourtActivity(options);

class CourtActivity implements BallActivity {
  readonly play: BallPlay;
  readonly sound: BallView['sound'];
  readonly voices: Voices;
  readonly #options: BallActivityOptions;
  readonly #view: BallView;
  readonly #others: RemoteAvatars;
  readonly #seen: SeenAvatars;
  readonly #shared: SharedAvatar;
  readonly #clock = createMatchClock();
  /** What `#named` gives; used again by its next call. */
  readonly #written: Players[number][] = [];
  #placedAt: Transform<'floor', 'arena'> | null = null;
  /** How many matches the server has voided, as far as is known here. */
  #voided = 0;
  #notice: { readonly text: string; readonly until: number } | null = null;
  #now = 0;

  constructor(options: BallActivityOptions) {
    const { quality, surroundings, mannequin, onCaption } = options;
    this.#options = options;
    this.play = createBallPlay(options);
    this.#view = createBallView({ quality, balls: defaultBallOptions.balls, onCaption });
    this.sound = this.#view.sound;
    this.voices = new Voices({
      play: this.play,
      terms: options.voiceTerms,
      openAudio: () => this.sound.open(),
      relayOnly: options.relayOnly,
    });
    this.#seen = new SeenAvatars(mannequin, options.fetchOwn, options.avatars);
    this.#others = createRemoteAvatars({
      load: (avatar) => this.#seen.load(avatar),
      plain: options.plainOthers,
      mouthOf: (seat) => this.voices.mouthOf(seat),
      onRefused: (avatar, reason) => this.#tellRefused(avatar, reason),
    });
    this.#shared = new SharedAvatar({
      exchange: options.avatars,
      wear: options.worn,
      tell: (avatar) => this.play.wear(avatar),
      notify: options.notify,
    });
    surroundings.scene.add(this.#view.own, this.#others.object);
    this.#place();
  }

  begin(time: number): void {
    this.#now = time;
    this.play.begin(time);
    this.voices.begin();
    this.#shared.follow(this.play.room);
    this.#place();
    const voided = this.play.room?.voided ?? 0;
    if (voided > this.#voided) this.#notice = { text: voidedNotice, until: time + noticeSeconds };
    this.#voided = voided;
  }

  act(time: number, catchUp: boolean): PlayerInput | null {
    return this.play.act(time, catchUp);
  }

  follow(frame: TrackingFrame, buttons: Buttons): readonly BallPulse[] {
    return this.#follow(frame.time, frame, buttons);
  }

  send(frame: TrackingFrame, pose: AvatarPose, fingers: Fingers): void {
    this.play.send(frame, pose, fingers);
  }

  grasp(side: Side, wrist: Pose<'floor'>, holding: Holding, target: MutableHandShape): boolean {
    const seen = this.play.newest;
    if (!seen) return false;
    if (seen.role !== 'holder') {
      if (seen.held[side] === null) return false;
      holding.ball(side, wrist, { at: ballInPalm(wrist, ballRadius, heldAt), radius: ballRadius }, target);
      return true;
    }
    if (!seen.opening) return false;
    transformPoint(this.play.floorFromArena, seen.opening.position, rim.at);
    rotate(this.play.floorFromArena.orientation, seen.opening.normal, rim.normal);
    holding.rim(side, wrist, rim, target);
    return true;
  }

  show(time: number, head: Pose<'floor'>, tracked: boolean): void {
    if (!tracked) this.#follow(time, null, noButtons);
    const seen = this.play.newest;
    this.#others.show(this.voices.show(seen?.bodies ?? noBodies), time);
    if (!seen) return;
    const { state, me, rotate, opening, aim, paused, events, cues } = seen;
    this.#view.show({
      state,
      time: seen.time,
      attendants: this.#named(seen.players),
      me,
      rotate,
      opening,
      aim,
      paused,
      secondsLeft: this.#clock.secondsLeft,
      head,
      pageTime: time,
      inRoom: !this.#ended,
      acting: this.#acting,
      voices: this.voices,
    });
    this.#view.hear(events, cues);
  }

  point({ origin, direction }: Ray, press: boolean): number | null {
    const { lobby } = this.#view;
    const hit = this.#ended ? null : lobby.buttonAt(origin, direction);
    lobby.setHovered(hit?.id ?? null);
    if (!hit) return null;
    if (press) this.#press(hit.id);
    return hit.distance;
  }

  get palette(): string | null {
    const seen = this.play.newest;
    const station = seen && seen.me !== null ? seen.state.players[seen.me]?.station : undefined;
    return station === undefined ? null : (seatLooks[station]?.palette ?? null);
  }

  bodyOf(seat: number): ReturnType<BallActivity['bodyOf']> {
    const body = this.play.newest?.bodies.find(({ id }) => id === seat);
    const pelvis = this.#others.jointsOf(seat)?.hips;
    if (!body || !pelvis) return null;
    const { position, orientation } = body.pose.head;
    const eyes = transformPose(body.placement, { position, orientation });
    return { pelvis, eyes };
  }

  get seats(): readonly number[] {
    return this.play.newest?.bodies.map(({ id }) => id) ?? [];
  }

  round(): BallRound | null {
    const seen = this.play.newest;
    if (!seen) return null;
    const { state, me, rotate, spectators, paused } = seen;
    const players = this.#named(seen.players);
    const own = me === null ? null : state.players[me];
    return {
      phase: state.phase,
      score: state.score,
      of: state.options.balls,
      ballsLeft: ballsLeft(state),
      secondsLeft: this.#clock.secondsLeft,
      seconds: state.options.seconds,
      paused,
      waiting: this.#waiting(seen, players),
      connection: this.#connection(),
      ended: this.#ended ? (bannerText(this.play.status) ?? 'The connection has ended.') : null,
      throws: own?.role === 'thrower',
      role: me === null ? 'Watching' : roleOf(state, me),
      seat: me,
      ready: own?.ready ?? false,
      rotate,
      spectators,
      people: placesOf(state, players, this.voices),
      voices: this.voices.state,
    };
  }

  banner(): string | null {
    const notice = this.#notice;
    return bannerText(this.play.status) ?? (notice && this.#now < notice.until ? notice.text : null);
  }

  probe(): CourtProbe | null {
    const seen = this.play.probe();
    return seen && { ...seen, secondsLeft: this.#clock.secondsLeft, voices: this.voices.probe() };
  }

  players(): readonly PlayerProbe[] {
    return playersOf(this.play, this.#others);
  }

  dispose(): void {
    this.voices.dispose();
    this.play.leave();
    this.#view.own.removeFromParent();
    this.#options.surroundings.setSurroundings(null);
    this.#seen.leave();
    this.#others.dispose();
    this.#view.dispose();
  }

  /** Others are seen all the same, as the plain one. */
  #tellRefused(avatar: WornAvatar, reason: unknown): void {
    const seats = this.play.room?.seats ?? [];
    const names = seats.flatMap((seat, index) =>
      seat?.avatar === avatar && index !== this.play.room?.mySeat ? [seat.name] : [],
    );
    // Who has put on something else meanwhile is not spoken of.
    if (names.length === 0) return;
    const why = firstLine(reasonOf(reason)).replace(/^the avatar: /, '');
    this.#options.notify('info', `The avatar of ${names.join(' and ')} is not shown, a mannequin is: ${why}`);
  }

  /** A built-in player moves the own body, with no person behind it. */
  get #acting(): boolean {
    return this.#options.acting() && !this.#options.steering();
  }

  /** This page is in the room no longer. */
  get #ended(): boolean {
    return this.play.status.phase === 'ended';
  }

  /** The court turns round the viewer: again with every change of seat. */
  #place(): void {
    const at = this.play.floorFromArena;
    if (at === this.#placedAt) return;
    this.#placedAt = at;
    this.#options.surroundings.setSurroundings(this.#view.placed(at));
  }

  /** The players as they are written of on this page; the list lasts until the next call. */
  #named(players: Players): Players {
    if (!this.#options.unnamed) return players;
    const written = this.#written;
    written.length = players.length;
    players.forEach((player, i) => {
      written[i] = player?.me ? { ...player, name: ownName } : player;
    });
    return written;
  }

  #follow(time: number, frame: TrackingFrame | null, buttons: Buttons): readonly BallPulse[] {
    const seen = this.play.follow(time, frame, buttons);
    if (!seen) return [];
    this.#clock.follow(seen.state);
    const { me, role, events, haptics } = seen;
    if (me === null || role === null || events.length === 0) return haptics;
    return [...haptics, ...eventHaptics(events, me, role)];
  }

  /** Does what a button of the lobby's sheet says. */
  #press(id: LobbyButton): void {
    const seat = seatOfButton(id);
    const seen = this.play.newest;
    if (seat !== null) this.play.sit(seat);
    else if (id === 'rotate') this.play.rotate(!(seen?.rotate ?? false));
    else this.play.ready(!(seen && seen.me !== null && seen.state.players[seen.me]?.ready));
  }

  #waiting({ state, me, rotate }: BallFrame, people: Players): string | null {
    if (this.#ended) return null;
    const seconds = Math.ceil(this.#clock.secondsLeft);
    return waitingFor({ state, seconds, people, me, rotate, acting: this.#acting });
  }

  /** How good the connection is, in words; null: it has ended, or the room is in this page. */
  #connection(): string | null {
    const delay = this.play.room?.delay ?? null;
    return delay === null || this.#ended ? null : connectionText(delay);
  }
}
