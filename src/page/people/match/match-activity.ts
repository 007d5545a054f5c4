import {
  type AvatarPose,
  type Buttons,
  type Calibration,
  defaultAvatar,
  type Fingers,
  type HapticPulse,
  type MutableHandShape,
  nothingPressed,
  type PointerTarget,
  type TrackingFrame,
} from 'threepoint/core';
import type { Pose, Ray, Side, Transform } from 'threepoint/math';
import type { ObjectHolds } from 'threepoint/three';
import type { SimulatedInput } from 'threepoint-games';
import { defaultBallOptions } from 'threepoint-games/ball';
import { bannerText } from 'threepoint-rooms';
import type { RoomBodies } from 'threepoint-rooms/three';
import type { ActivityPanel, OpenActivity, PlayerProbe, Watched } from '../../activity/activity';
import type { ActivityContext } from '../../activity/activity-context';
import type { ActivityMenu } from '../../activity/activity-menu';
import { BallView } from '../../ball/ball-view';
import { graspAtCourt } from '../../ball/court-grasp';
import { CourtInput } from '../../ball/court-input';
import type { BallFrame } from '../../ball/match/ball-frame';
import { BallPlay } from '../../ball/match/ball-play';
import { type BallProbe, playerProbes } from '../../ball/match/ball-probe';
import { eventHaptics } from '../../ball/sound/ball-haptics';
import type { CameraScene } from '../../scene/desktop-view';
import { BallMenu } from '../menu/people-menu';
import { createBallPanel } from '../panel/match-panel';
import { type BallRound, ballRound } from '../panel/match-round';
import { ownName } from '../view/displayed-match';
import { type LobbyButton, seatOfButton } from '../view/lobby-sheet';
import { seatLooks } from '../view/seat-looks';
import { BlockList } from '../voices/block-list';
import { Voices, type VoicesProbe } from '../voices/voices';
import { CourtCamera } from './match-camera';
import { createCourtAvatars } from './other-bodies';
import { assignedSeat, type BallPlace, connectionsFor } from './room-place';

/** The state of a match and of its voices, for tests and tools. */
export type BallActivityProbe = BallProbe & { readonly voices: VoicesProbe };

type Players = BallFrame['players'];

const noBodies: BallFrame['bodies'] = [];
const noEvents: BallFrame['events'] = [];
const noSeats: readonly never[] = [];
/** How long the notice of a voided match is shown [s]. */
const noticeSeconds = 8;
const voidedNotice = 'The server was restarted, so this round does not count. You can start a new one.';

/** The ball game in the page: the court, the other players' bodies, and the user's part in the match. */
export class BallActivity implements OpenActivity {
  readonly play: BallPlay;
  readonly sound: BallView['sound'];
  readonly voices: Voices;
  readonly blocked = new BlockList(() => this.voices.seats.applyBlocks());
  readonly camera: CourtCamera;
  readonly mirrorSide = null;
  readonly #context: ActivityContext;
  readonly #view: BallView;
  readonly #avatars: RoomBodies;
  readonly #menu: BallMenu;
  readonly #input: CourtInput;
  /** The width up to which the bar lies over the picture. */
  readonly #phone = matchMedia('(max-width: 480px)');
  /** The user joined without a name, and reads “You” instead of the one that others see. */
  readonly #unnamed: boolean;
  /** The result of `#named`; the next call overwrites it. */
  readonly #written: Players[number][] = [];
  #placedAt: Transform<'floor', 'arena'> | null = null;
  #newestFrame: TrackingFrame | null = null;
  /** The number of voided matches that the user was notified of. */
  #voided = 0;
  #notice: { readonly text: string; readonly until: number } | null = null;
  #now = 0;

  /** `mannequin`: the file of the body that other players have. */
  constructor(context: ActivityContext, room: BallPlace, mannequin: ArrayBuffer) {
    const { quality, place, settings, switches, body, layout, stage, onCaption } = context;
    this.#context = context;
    this.#input = new CourtInput(context, () => this.play ?? null);
    this.#unnamed = place === null && settings.name === '';
    this.play = new BallPlay({
      connect: room.connect,
      visitor: {
        name: place?.participant || settings.name || settings.defaultName,
        calibration: body.calibration,
        ...(place && { seat: place.members.indexOf(place.participant) }),
        ...(switches.spectate && { spectate: true }),
      },
      bots: () => settings.bots && place === null,
      acting: () => this.#input.isActor,
      steering: () => this.#input.steering(),
      seed: layout.seed,
    });
    this.#view = new BallView({ quality, balls: defaultBallOptions.balls, onCaption });
    this.sound = this.#view.sound;
    this.voices = new Voices({
      play: this.play,
      blocked: this.blocked,
      terms: room.voiceTerms,
      openAudio: () => this.sound.open(),
      relayOnly: () => settings.voicesByRelay,
    });
    this.#avatars = createCourtAvatars({
      context,
      exchange: room.avatars,
      mannequin,
      play: this.play,
      voices: this.voices,
    });
    this.camera = new CourtCamera({ context, play: this.play, hipsOf: (seat) => this.#avatars.jointsOf(seat)?.hips });
    this.#menu = new BallMenu(this, context);
    stage.studio.scene.add(this.#view.own, this.#avatars.object);
    this.#place();
  }

  get scene(): CameraScene {
    return this.camera.scene;
  }

  /** The colours of the user's seat; null: a spectator. */
  get palette(): string | null {
    const newest = this.play.newest;
    const station = newest && newest.me !== null ? newest.state.players[newest.me]?.station : undefined;
    return station === undefined ? null : (seatLooks[station]?.palette ?? null);
  }

  get watched(): Watched | null {
    return this.camera.watched;
  }

  get mouth(): number {
    return this.voices.seats.ownMouth;
  }

  begin(time: number): void {
    this.#now = time;
    this.play.begin(time);
    this.blocked.update(this.play.room?.seats ?? noSeats);
    this.voices.begin();
    this.#avatars.share();
    this.#place();
    const voided = this.play.room?.voidedRounds ?? 0;
    if (voided > this.#voided) this.#notice = { text: voidedNotice, until: time + noticeSeconds };
    this.#voided = voided;
  }

  act(time: number): SimulatedInput | null {
    return this.play.act(time, !this.#context.headset.worn);
  }

  update(frame: TrackingFrame, buttons: Buttons): readonly HapticPulse[] {
    this.#newestFrame = frame;
    return this.#follow(frame.time, frame, this.#context.study.run?.idle ? nothingPressed : buttons);
  }

  send(frame: TrackingFrame, pose: AvatarPose, fingers: Fingers): void {
    this.play.send(frame, pose, fingers);
  }

  grasp(side: Side, wrist: Pose<'floor'>, holding: ObjectHolds, target: MutableHandShape): boolean {
    return graspAtCourt(this.play, side, wrist, holding, target);
  }

  show(time: number, frame: TrackingFrame | null): void {
    if (!frame) this.#follow(time, null, nothingPressed);
    const newest = this.play.newest;
    const bodies = newest?.bodies ?? noBodies;
    this.voices.seats.locate(bodies);
    this.#avatars.show(this.blocked.visible(bodies), time);
    if (!newest) return;
    const { pose } = this.#context.stage.view;
    this.#view.showBoards(this.#context.headset.worn || !this.#phone.matches);
    this.#view.show({
      ...newest,
      attendants: this.#named(newest.players),
      head: (this.camera.spectating ? null : (frame ?? this.#newestFrame)?.head) ?? pose,
      pageTime: time,
      inRoom: !this.#ended,
      acting: this.acting,
      voices: this.voices.seats,
      hidden: this.blocked.hidden,
    });
    this.#view.playEvents(newest.resumed ? noEvents : newest.events, newest.cues);
  }

  point({ origin, direction }: Ray, press: boolean): PointerTarget | null {
    const { lobby } = this.#view;
    const hit = this.#ended ? null : lobby.buttonAt(origin, direction);
    lobby.setHovered(hit?.id ?? null);
    if (!hit) return null;
    if (press) this.#press(hit.id);
    return { ...hit, owner: 'lobby' };
  }

  discontinuity(): void {
    this.play.discontinuity();
  }

  sessionChanged(): void {
    this.#menu.close();
  }

  calibrate(calibration: Calibration): void {
    this.play.calibrate(calibration);
  }

  setAway(away: boolean): void {
    this.play.away(away);
  }

  toggleMuted(): void {
    this.voices.toggleMuted();
  }

  banner(): string | null {
    const notice = this.#notice;
    return bannerText(this.play.status) ?? (notice && this.#now < notice.until ? notice.text : null);
  }

  createPanel(): ActivityPanel {
    return createBallPanel(this, this.#context);
  }

  menu(): ActivityMenu {
    return this.#menu.state();
  }

  round(): BallRound | null {
    const frame = this.play.newest;
    if (!frame) return null;
    const { play, voices, acting } = this;
    const players = this.#named(frame.players);
    return ballRound({ play, frame, players, acting, voices });
  }

  probe(): BallActivityProbe | null {
    const probe = this.play.probe();
    return probe && { ...probe, voices: this.voices.probe() };
  }

  players(): readonly PlayerProbe[] {
    return playerProbes(this.play, this.#avatars);
  }

  dispose(): void {
    this.voices.dispose();
    this.play.leave();
    this.#context.stage.studio.setSurroundings(null);
    this.#avatars.dispose();
    this.#view.dispose();
  }

  /** A simulated player moves the user's body: no person can be asked. */
  get acting(): boolean {
    return this.#input.isActor;
  }

  /** This page is no longer in the room. */
  get #ended(): boolean {
    return this.play.status.phase === 'ended';
  }

  /** Turns the court around the user, after every change of seat. */
  #place(): void {
    const at = this.play.floorFromArena;
    if (at === this.#placedAt) return;
    this.#placedAt = at;
    this.#context.stage.studio.setSurroundings(this.#view.placed(at));
  }

  /** The players with the names that this page shows; the list is valid until the next call. */
  #named(players: Players): Players {
    if (!this.#unnamed) return players;
    const written = this.#written;
    written.length = players.length;
    players.forEach((player, i) => {
      written[i] = player?.me ? { ...player, name: ownName } : player;
    });
    return written;
  }

  #follow(time: number, frame: TrackingFrame | null, buttons: Buttons): readonly HapticPulse[] {
    const newest = this.play.follow(time, frame, buttons);
    if (!newest) return [];
    const { me, role, events, haptics } = newest;
    if (me === null || role === null || events.length === 0) return haptics;
    return [...haptics, ...eventHaptics(events, me, role)];
  }

  #press(id: LobbyButton): void {
    const seat = seatOfButton(id);
    const newest = this.play.newest;
    if (seat !== null) this.play.sit(seat);
    else if (id === 'rotate') this.play.rotate(!(newest?.state.rotate ?? false));
    else this.play.ready(!(newest && newest.me !== null && newest.state.players[newest.me]?.ready));
  }
}

/** Returns the room to play in: the one that a study assigned, the one in the address, or one in this page. */
async function roomFor({ place, switches, clock, server, layout }: ActivityContext): Promise<BallPlace> {
  if (place) return assignedSeat(place.seat, clock);
  // A server that does not answer now may answer later. Without a server the match is in this page.
  const hosted = switches.room !== null && (await server.whenKnown()) !== 'none';
  return connectionsFor(hosted ? switches.room : null, {
    seed: layout.seed,
    clock,
    ...(switches.seconds && { seconds: switches.seconds }),
    ...(switches.balls && { balls: switches.balls }),
  });
}

/** Downloads the body of other players and connects to the room. Rejects with a reason. */
export async function openBallActivity(context: ActivityContext): Promise<BallActivity> {
  const [mannequin, room] = await Promise.all([context.fetchBuiltInAvatar(defaultAvatar), roomFor(context)]);
  return new BallActivity(context, room, mannequin);
}
