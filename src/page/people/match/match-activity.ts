import {
  type AvatarPose,
  type Buttons,
  type Calibration,
  defaultAvatar,
  type Fingers,
  type HapticPulse,
  nothingPressed,
  type PointerTarget,
  type TrackingFrame,
} from 'threepoint/core';
import type { GazeTargets } from 'threepoint/internal/three';
import type { Pose, Ray, Transform } from 'threepoint/math';
import type { SimulatedInput } from 'threepoint-games';
import { bannerText } from 'threepoint-rooms/internal';
import type { RoomBodies } from 'threepoint-rooms/internal/three';
import type { HostedGame } from 'threepoint-rooms/room';
import type { ActivityPanel, OpenActivity, PlayerProbe, Watched } from '../../activity/activity';
import type { ActivityContext } from '../../activity/activity-context';
import type { ActivityMenu } from '../../activity/activity-menu';
import type { CameraScene } from '../../scene/desktop-view';
import type { AudibleStage } from '../../scene/sound/sound-stage';
import type { Surroundings } from '../../scene/surroundings';
import { PeopleMenu } from '../menu/people-menu';
import { createMatchPanel } from '../panel/match-panel';
import { type MatchRound, matchRound } from '../panel/match-round';
import { type LobbyButton, seatOfButton } from '../view/lobby-sheet';
import type { PeopleScene, PeopleView } from '../view/people-view';
import { seatLooks } from '../view/seat-looks';
import { BlockList } from '../voices/block-list';
import { Voices } from '../voices/voices';
import { MatchCamera, type MatchScenes } from './match-camera';
import type { MatchFrame } from './match-frame';
import type { MatchPlay, MatchPlayOptions } from './match-play';
import { createOtherBodies } from './other-bodies';
import { type PlayRoom, roomFor } from './play-room';
import type { SeatedGame } from './seated-game';

/** One frame of a match as its view draws it. */
export type MatchScene<Game extends HostedGame, Frame extends MatchFrame<Game>> = Frame &
  PeopleScene<Game> & {
    /** The viewer's eyes and ears, floor frame of the user. */
    readonly head: Pose<'floor'>;
  };

/** The view of a game, with the people in it but without their bodies. */
export interface MatchView<Game extends HostedGame, Frame extends MatchFrame<Game>> {
  readonly people: PeopleView<Game>;
  readonly sound: AudibleStage;
  /** Returns the surroundings of the game in the user's floor frame; called after every change of the seat. */
  placed(floorFromArena: Transform<'floor', 'arena'>): Surroundings;
  /** Shows or hides the boards. A phone's window is covered by the bar, which has their figures. */
  showBoards?(visible: boolean): void;
  show(scene: MatchScene<Game, Frame>): void;
  /** Adds what attracts eyes, as the newest `show` drew it, floor frame. */
  addGazeTargets?(targets: GazeTargets): void;
  /** Plays and captions the events since the last frame. Called after `show`. */
  playEvents?(events: readonly Game['event'][], frame: Frame): void;
  dispose(): void;
}

/** The parts of an activity that its game supplies. */
export interface MatchParts<Game extends HostedGame, Frame extends MatchFrame<Game>, Play> {
  readonly game: SeatedGame<Game>;
  readonly view: MatchView<Game, Frame>;
  readonly scenes: MatchScenes;
  /** A simulated player moves the user's body. */
  acting(): boolean;
  createPlay(options: MatchPlayOptions<Game>): Play;
}

/** What a match is opened with: the page, the room, and the file of the body that other players have. */
export interface MatchOpening<Game extends HostedGame> {
  readonly context: ActivityContext;
  readonly room: PlayRoom<Game>;
  readonly mannequin: ArrayBuffer;
}

const none: readonly never[] = [];
/** How long the notice of a voided match is shown [s]. */
const noticeSeconds = 8;
const voidedNotice = 'The server was restarted, so this round does not count. You can start a new one.';

/** A game of several people in the page: surroundings, the other players' bodies, and the user's part in the match. */
export abstract class MatchActivity<
  Game extends HostedGame,
  Frame extends MatchFrame<Game> = MatchFrame<Game>,
  Play extends MatchPlay<Game, Frame> = MatchPlay<Game, Frame>,
> implements OpenActivity
{
  readonly game: SeatedGame<Game>;
  readonly play: Play;
  readonly sound: AudibleStage;
  readonly voices: Voices;
  readonly blocked = new BlockList(() => this.voices.seats.applyBlocks());
  readonly camera: MatchCamera;
  readonly mirrorSide = null;
  protected readonly context: ActivityContext;
  readonly #parts: MatchParts<Game, Frame, Play>;
  /** In a room with other people everyone presses Ready, also who lets a simulated player play. */
  readonly readyByItself: () => boolean;
  readonly #isThere = (seat: number): boolean =>
    seat === this.play.newest?.me || this.#bodies.drawnAs(seat) !== null || this.blocked.hidden.has(seat);
  readonly #bodies: RoomBodies;
  readonly #menu: PeopleMenu;
  /** The width up to which the bar lies over the picture. */
  readonly #phone = matchMedia('(max-width: 480px)');
  #placedAt: Transform<'floor', 'arena'> | null = null;
  #newestFrame: TrackingFrame | null = null;
  /** The number of voided matches that the user was notified of. */
  #voided = 0;
  #notice: { readonly text: string; readonly until: number } | null = null;
  #now = 0;

  constructor({ context, room, mannequin }: MatchOpening<Game>, parts: MatchParts<Game, Frame, Play>) {
    const { place, settings, switches, body, stage } = context;
    const { game, view, scenes, acting } = parts;
    this.context = context;
    this.game = game;
    this.#parts = parts;
    this.readyByItself = () => !room.shared && acting();
    this.play = parts.createPlay({
      connect: room.connect,
      visitor: {
        name: place?.participant || settings.name || settings.defaultName,
        calibration: body.calibration,
        ...(place && { seat: place.members.indexOf(place.participant) }),
        ...(switches.spectate && { spectate: true }),
      },
      unnamed: place === null && settings.name === '',
      readyByItself: this.readyByItself,
    });
    const { play } = this;
    this.sound = view.sound;
    this.voices = new Voices({
      client: play,
      blocked: this.blocked,
      terms: room.voiceTerms,
      openAudio: () => this.sound.open(),
      relayOnly: () => settings.voicesByRelay,
    });
    this.#bodies = createOtherBodies({ context, exchange: room.avatars, mannequin, play, voices: this.voices });
    this.camera = new MatchCamera({ context, play, scenes, hipsOf: (seat) => this.#bodies.jointsOf(seat)?.hips });
    this.#menu = new PeopleMenu(this, context);
    stage.studio.scene.add(view.people.lobby.object, this.#bodies.object);
    this.#place();
  }

  /** Returns the input of the simulated player on the user's seat, or of the one that a pointer steers. */
  abstract act(time: number): SimulatedInput | null;

  /** Returns the state of the match and of its voices, for tests and tools; null: there is no match. */
  abstract probe(): object | null;

  get scene(): CameraScene {
    return this.camera.scene;
  }

  /** The colours of the user's seat; null: a spectator. */
  get palette(): string | null {
    const newest = this.play.newest;
    if (!newest || newest.me === null) return null;
    return seatLooks[this.game.stationOf(newest.state, newest.me)]?.palette ?? null;
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
    this.blocked.update(this.play.room?.seats ?? none);
    this.voices.begin();
    this.#bodies.share();
    this.#place();
    const voided = this.play.room?.voidedRounds ?? 0;
    if (voided > this.#voided) this.#notice = { text: voidedNotice, until: time + noticeSeconds };
    this.#voided = voided;
  }

  update(frame: TrackingFrame, buttons: Buttons): readonly HapticPulse[] {
    this.#newestFrame = frame;
    const pressed = this.context.study.run?.idle ? nothingPressed : buttons;
    return this.play.follow(frame.time, frame, pressed)?.haptics ?? [];
  }

  send(frame: TrackingFrame, pose: AvatarPose, fingers: Fingers): void {
    this.play.sendPose(frame.time, pose, fingers);
  }

  show(time: number, frame: TrackingFrame | null): void {
    if (!frame) this.play.follow(time, null, nothingPressed);
    const newest = this.play.newest;
    const bodies = newest?.bodies ?? none;
    this.voices.seats.locate(bodies);
    this.#parts.view.addGazeTargets?.(this.context.gazeTargets);
    this.#bodies.show(this.blocked.visible(bodies), time);
    if (!newest) return;
    const { headset, stage } = this.context;
    const { view } = this.#parts;
    view.showBoards?.(headset.worn || !this.#phone.matches);
    view.show({
      ...newest,
      head: (this.camera.spectating ? null : (frame ?? this.#newestFrame)?.head) ?? stage.view.pose,
      pageTime: time,
      inRoom: this.#joined,
      readyByItself: this.readyByItself(),
      voices: this.voices.seats,
      hidden: this.blocked.hidden,
      isThere: this.#isThere,
    });
    view.playEvents?.(newest.resumed ? none : newest.events, newest);
  }

  point({ origin, direction }: Ray, press: boolean): PointerTarget | null {
    const { sheet } = this.#parts.view.people.lobby;
    const hit = this.#joined ? sheet.buttonAt(origin, direction) : null;
    sheet.setHovered(hit?.id ?? null);
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
    const { status, room } = this.play;
    return (
      bannerText(status, room !== null && room.mySeat !== null) ??
      (notice && this.#now < notice.until ? notice.text : null)
    );
  }

  createPanel(): ActivityPanel {
    return createMatchPanel(this, this.context);
  }

  menu(): ActivityMenu {
    return this.#menu.state();
  }

  round(): MatchRound | null {
    const frame = this.play.newest;
    if (!frame) return null;
    const { game, play, voices } = this;
    return matchRound(game, { play, frame, readyByItself: this.readyByItself(), voices });
  }

  players(): readonly PlayerProbe[] {
    const { newest, room } = this.play;
    return (newest?.bodies ?? []).flatMap(({ id, opacity }): PlayerProbe[] => {
      const player = newest?.players[id];
      if (!player) return [];
      const { name, bot, presence } = player;
      const drawn = Object.entries(this.#bodies.jointsOf(id) ?? {});
      const joints = Object.fromEntries(drawn.map(([joint, { x, y, z }]) => [joint, [x, y, z] as const]));
      const { avatar = defaultAvatar } = room?.seats[id] ?? {};
      return [{ seat: id, name, bot, presence, opacity, avatar, drawnAs: this.#bodies.drawnAs(id), joints }];
    });
  }

  dispose(): void {
    this.voices.dispose();
    this.play.leave();
    this.context.stage.studio.setSurroundings(null);
    this.#bodies.dispose();
    this.#parts.view.dispose();
  }

  /** This page is in the room, and connected to it. */
  get #joined(): boolean {
    return this.play.status.phase === 'joined';
  }

  /** Turns the surroundings of the game around the user, after every change of seat. */
  #place(): void {
    const at = this.play.floorFromArena;
    if (at === this.#placedAt) return;
    this.#placedAt = at;
    this.context.stage.studio.setSurroundings(this.#parts.view.placed(at));
  }

  #press(id: LobbyButton): void {
    const seat = seatOfButton(id);
    const { play } = this;
    const newest = play.newest;
    if (seat !== null) play.connection?.changeSeat(seat);
    else if (id === 'option') play.setOption?.(!(newest && this.game.option?.isOn(newest.state)));
    else play.connection?.setReady(!(newest && newest.me !== null && newest.state.players[newest.me]?.ready));
  }
}

/** Downloads the body of other players and connects to the room of a game. Rejects with a reason. */
export async function openMatch<Game extends HostedGame>(
  game: SeatedGame<Game>,
  context: ActivityContext,
): Promise<MatchOpening<Game>> {
  const [mannequin, room] = await Promise.all([context.fetchBuiltInAvatar(defaultAvatar), roomFor(game, context)]);
  return { context, room, mannequin };
}
