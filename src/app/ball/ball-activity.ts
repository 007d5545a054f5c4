import { createRemoteAvatars } from '../../avatar/remote-avatars';
import type { AvatarPose } from '../../core/body/avatar-pose';
import type { BallPulse } from '../../core/games/ball/gestures';
import type { Performed } from '../../core/games/ball/player-postures';
import { defaultBallOptions } from '../../core/games/ball/rules';
import { ballsLeft } from '../../core/games/ball/state-readings';
import type { BallSteering } from '../../core/games/ball/steered-players';
import type { Buttons } from '../../core/games/button-presses';
import { type Pose, type Transform, transformPose } from '../../core/math/pose';
import type { Ray } from '../../core/math/ray';
import type { Side } from '../../core/math/side';
import type { Vec3 } from '../../core/math/vec3';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import { bannerText, connectionText } from '../../net/banner';
import type { Connection, Visitor } from '../../net/connection';
import type { Quality } from '../../scene/renderer';
import type { SurroundingsHost } from '../../scene/surroundings';
import type { BallRound } from './ball-bar';
import type { BallFrame, BallProbe } from './ball-frame';
import { type BallPlay, createBallPlay } from './ball-play';
import { createBallView } from './ball-view';
import { ownName, type Standing, seatOfButton, waitingFor } from './board-drawing';
import { roleTexts, seatLooks } from './court-plan';
import { eventHaptics } from './haptics';
import { createMatchClock } from './match-clock';

export interface BallActivityOptions {
  readonly quality: Quality;
  readonly surroundings: SurroundingsHost;
  /** The file of the body that others have. */
  readonly mannequin: ArrayBuffer;
  readonly visitor: Visitor;
  /** The visitor's name was given by the page: its player reads “You” instead. */
  readonly unnamed: boolean;
  connect(visitor: Visitor, time: number): Connection;
  bots(): boolean;
  acting(): boolean;
  /** What a mouse wants of the own player, floor frame; null: nothing, a built-in one plays. */
  steering(): BallSteering | null;
  readonly seed: number;
  readonly onCaption: (text: string) => void;
}

/** A player whom the tools may know of. */
export interface PlayerProbe {
  readonly seat: number;
  readonly name: string;
  readonly bot: boolean;
  readonly presence: string;
  readonly opacity: number;
  /** Joints as drawn, own floor frame [m]. */
  readonly joints: Readonly<Record<string, readonly [number, number, number]>>;
}

/** The ball game in the page: the court, the others' bodies, and one's own part in the match. */
export interface BallActivity {
  readonly play: BallPlay;
  readonly sound: ReturnType<typeof createBallView>['sound'];
  /** Once a frame, first. */
  begin(time: number): void;
  /** Head, hands and buttons of the built-in player on the own seat; null: no seat. */
  act(time: number, catchUp: boolean): Performed | null;
  /** The tracked frame as play: what it means is heard at once, what it feels like comes back. */
  follow(frame: TrackingFrame, buttons: Buttons): readonly BallPulse[];
  send(frame: TrackingFrame, pose: AvatarPose, grips: Readonly<Record<Side, number>>): void;
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
  probe(): BallProbe | null;
  players(): readonly PlayerProbe[];
  dispose(): void;
}

export function createBallActivity(options: BallActivityOptions): BallActivity {
  const { quality, surroundings, mannequin, onCaption } = options;
  const play = createBallPlay(options);
  const view = createBallView({ quality, balls: defaultBallOptions.balls, onCaption });
  const others = createRemoteAvatars(mannequin, 'mannequin.vrm');
  surroundings.scene.add(view.own, others.object);
  let placedAt: Transform<'floor', 'arena'> | null = null;
  let voided = 0;
  let notice: { readonly text: string; readonly until: number } | null = null;
  let now = 0;
  const clock = createMatchClock();

  /** The court turns round the viewer: again with every change of seat. */
  function place(): void {
    const at = play.floorFromArena;
    if (at === placedAt) return;
    placedAt = at;
    surroundings.setSurroundings(view.placed(at));
  }

  /** A built-in player moves the own body, with no person behind it. */
  const acting = () => options.acting() && !options.steering();
  const ended = () => play.status.phase === 'ended';

  const writtenOf: BallFrame['players'][number][] = [];
  /** The players as they are written of on this page; the list lasts until the next call. */
  function named(players: BallFrame['players']): BallFrame['players'] {
    if (!options.unnamed) return players;
    writtenOf.length = players.length;
    players.forEach((player, i) => {
      writtenOf[i] = player?.me ? { ...player, name: ownName } : player;
    });
    return writtenOf;
  }

  function follow(time: number, frame: TrackingFrame | null, buttons: Buttons): readonly BallPulse[] {
    const seen = play.follow(time, frame, buttons);
    if (!seen) return [];
    clock.follow(seen.state);
    const { me, role, events, haptics } = seen;
    if (me === null || role === null || events.length === 0) return haptics;
    return [...haptics, ...eventHaptics(events, me, role)];
  }

  const noBodies: BallFrame['bodies'] = [];
  const noButtons: Buttons = {
    left: { trigger: 0, grip: 0, pinch: 0 },
    right: { trigger: 0, grip: 0, pinch: 0 },
  };

  const triple = ({ x, y, z }: Vec3): readonly [number, number, number] => [x, y, z];

  place();
  return {
    play,
    sound: view.sound,
    begin(time) {
      now = time;
      play.begin(time);
      place();
      const times = play.room?.voided ?? 0;
      if (times > voided)
        notice = { text: 'The server was restarted: this round does not count. A new one can begin.', until: time + 8 };
      voided = times;
    },
    act: (time, catchUp) => play.act(time, catchUp),
    follow: (frame, buttons) => follow(frame.time, frame, buttons),
    send: (frame, pose, grips) => play.send(frame, pose, grips),
    show(time, head, tracked) {
      if (!tracked) follow(time, null, noButtons);
      const seen = play.newest;
      others.show(seen?.bodies ?? noBodies, time);
      if (!seen) return;
      const { state, me, rotate, opening, aim, paused, events, cues } = seen;
      const attendants = named(seen.players);
      view.show({
        state,
        time: seen.time,
        attendants,
        me,
        rotate,
        opening,
        aim,
        paused,
        secondsLeft: clock.secondsLeft,
        head,
        pageTime: time,
        inRoom: !ended(),
        acting: acting(),
      });
      view.hear(events, cues);
    },
    point({ origin, direction }, press) {
      const hit = ended() ? null : view.lobby.buttonAt(origin, direction);
      view.lobby.setHovered(hit?.id ?? null);
      if (!hit) return null;
      if (press) {
        const seat = seatOfButton(hit.id);
        const seen = play.newest;
        if (seat !== null) play.sit(seat);
        else if (hit.id === 'rotate') play.rotate(!(seen?.rotate ?? false));
        else play.ready(!(seen && seen.me !== null && seen.state.players[seen.me]?.ready));
      }
      return hit.distance;
    },
    get palette() {
      const seen = play.newest;
      const station = seen && seen.me !== null ? seen.state.players[seen.me]?.station : undefined;
      return station === undefined ? null : (seatLooks[station]?.palette ?? null);
    },
    bodyOf(seat) {
      const body = play.newest?.bodies.find(({ id }) => id === seat);
      const joints = others.jointsOf(seat);
      const pelvis = joints?.hips;
      if (!body || !pelvis) return null;
      const { position, orientation } = body.pose.head;
      const eyes = transformPose(body.placement, { position, orientation });
      return { pelvis, eyes };
    },
    get seats() {
      return play.newest?.bodies.map(({ id }) => id) ?? [];
    },
    round() {
      const seen = play.newest;
      if (!seen) return null;
      const { state, me, rotate, spectators } = seen;
      const players = named(seen.players);
      const standing: Standing = {
        state,
        seconds: Math.ceil(clock.secondsLeft),
        people: players,
        me,
        rotate,
        acting: acting(),
      };
      const delay = play.room?.delay ?? null;
      const roleOf = (player: number): string => roleTexts[state.players[player]?.station ?? player] ?? '';
      return {
        phase: state.phase,
        score: state.score,
        of: state.options.balls,
        ballsLeft: ballsLeft(state),
        secondsLeft: clock.secondsLeft,
        seconds: state.options.seconds,
        paused: seen.paused,
        waiting: ended() ? null : waitingFor(standing),
        connection: delay === null || ended() ? null : connectionText(delay),
        ended: ended() ? (bannerText(play.status) ?? 'The connection has ended.') : null,
        throws: me !== null && state.players[me]?.role === 'thrower',
        role: me === null ? 'Watching' : roleOf(me),
        seat: me,
        ready: me !== null && (state.players[me]?.ready ?? false),
        rotate,
        spectators,
        people: players.map((player, seat) => ({
          seat,
          name: player?.name ?? 'free',
          role: roleOf(seat),
          free: player === null || (player.bot && !player.me),
        })),
      };
    },
    banner() {
      return bannerText(play.status) ?? (notice && now < notice.until ? notice.text : null);
    },
    probe() {
      const seen = play.probe();
      return seen && { ...seen, secondsLeft: clock.secondsLeft };
    },
    players() {
      const seen = play.newest;
      return (seen?.bodies ?? []).flatMap(({ id, opacity }): PlayerProbe[] => {
        const player = seen?.players[id];
        if (!player) return [];
        const { name, bot, presence } = player;
        const joints = Object.entries(others.jointsOf(id) ?? {}).map(([joint, at]) => [joint, triple(at)] as const);
        return [{ seat: id, name, bot, presence, opacity, joints: Object.fromEntries(joints) }];
      });
    },
    dispose() {
      play.leave();
      view.own.removeFromParent();
      surroundings.setSurroundings(null);
      others.dispose();
      view.dispose();
    },
  };
}
