import type { BallEvent, BallState } from 'threepoint-games/ball/ball-state';
import { ballsLeft } from 'threepoint-games/ball/state-selectors';
import { rotationForRound } from 'threepoint-games/ball/stations';
import { drawText, type TextStyle, textWidth } from 'threepoint-ui/vr-panel';
import { ink, paintCard, paintGround } from '../../scene/boards/board-style';
import { paintScoreHeading } from '../../scene/boards/score-heading';
import { paintButton, type SheetButton } from '../../scene/boards/sheet';
import { roleTexts, seatLooks } from '../court/court-plan';
import type { PlayerFrame } from '../match/ball-frame';

/** A player on a seat, as boards and labels write of them. */
export type DisplayedPlayer = Pick<PlayerFrame, 'name' | 'bot' | 'presence' | 'me'>;

/** A match as boards show it: the state of this frame and the person on each seat. */
export interface DisplayedMatch {
  readonly state: BallState;
  /** Whole seconds until the bell, rounded up. */
  readonly seconds: number;
  readonly players: readonly (DisplayedPlayer | null)[];
  /** The user's player; null: a spectator. */
  readonly me: number | null;
  /** Roles move on with every match. */
  readonly rotate: boolean;
  /** A simulated player has the user's seat, and is ready without being asked. */
  readonly acting: boolean;
}

/** What a player reads in place of a name that they have not given. */
export const ownName = 'You';

/** Returns a name that marks bots as such. */
export const displayName = ({ name, bot }: Pick<DisplayedPlayer, 'name' | 'bot'>): string =>
  bot && !/\bbot\b/i.test(name) ? `${name} (bot)` : name;

/** Balls that each player's throws have brought into the basket. */
export const catchesOf = (state: BallState, player: number): number =>
  state.balls.filter((place) => place.on === 'basket' && place.thrower === player).length;

/** What the last thing that happened reads like on the board; null: nothing to say. */
export function eventLine(event: BallEvent, people: readonly (DisplayedPlayer | null)[]): string | null {
  const who = 'player' in event ? people[event.player] : null;
  const name = who?.me ? 'you' : (who?.name ?? 'A player');
  switch (event.type) {
    case 'started':
      return 'Go!';
    case 'caught':
      return `In! Thrown by ${name}`;
    case 'missed':
      return who?.me ? 'Your ball is on the floor' : `${name}’s ball is on the floor`;
    case 'bounced':
      return event.off === 'basket' ? 'Off the rim' : null;
    case 'left':
      return who?.me ? null : `${name} has left`;
    case 'joined':
      return who?.me ? null : `${name} has joined`;
    default:
      return null;
  }
}

/** Returns the line of the board while nothing happens. */
export function waitingLine({ state, players }: DisplayedMatch): string {
  if (state.phase === 'running') return 'Catch them in the basket';
  if (state.phase === 'over') return state.end === 'time' ? 'Time is up' : 'All balls thrown';
  const there = players.flatMap((person, player) => (person ? [player] : []));
  const roles = new Set(there.map((player) => state.players[player]?.role));
  if (!roles.has('thrower')) return 'Waiting for a thrower';
  if (!roles.has('holder')) return 'Waiting for a basket holder';
  const waiting = there.filter((player) => !state.players[player]?.ready).length;
  return waiting === 1 ? 'Waiting for one player' : `Waiting for ${waiting} players`;
}

const listed = (names: readonly string[]): string =>
  names.length < 2 ? (names[0] ?? '') : `${names.slice(0, -1).join(', ')} and ${names.at(-1)}`;

/** Describes what a match waits for; null: it is running. */
export function waitingSentence(standing: DisplayedMatch): string | null {
  const { state, players, me, rotate, acting } = standing;
  if (state.phase === 'running') return null;
  const there = players.flatMap((person, player) => (person ? [player] : []));
  const taken = there.flatMap((player) => state.players[player]?.station ?? []);
  // Roles move on between two matches alone.
  const canPlay = rotationForRound(taken, rotate && state.phase === 'over') !== null;
  if (!canPlay) return `${waitingLine({ ...standing, state: { ...state, phase: 'ready' } })}.`;
  const idle = there.filter((player) => !state.players[player]?.ready);
  const names = idle.flatMap((player) => (player !== me && players[player] ? [displayName(players[player])] : []));
  const press = state.phase === 'over' ? 'Play again' : 'Ready';
  if (me !== null && !acting && idle.includes(me)) return `Waiting for ${listed(['you', ...names])}: press ${press}.`;
  return names.length > 0 ? `Waiting for ${listed(names)}.` : 'The match starts in a moment.';
}

export const boardSize = { width: 1024, height: 588 } as const;

/** Score, clock, balls left and the last sentence. */
export function paintBoard(context: CanvasRenderingContext2D, standing: DisplayedMatch, line: string): void {
  const { state, seconds } = standing;
  const { width, height } = boardSize;
  paintGround(context, width, height);
  paintScoreHeading(context, {
    score: state.score,
    of: state.options.balls,
    seconds,
    running: state.phase === 'running',
  });

  const left = ballsLeft(state);
  drawText(context, 'BALLS', [64, 430], { font: '700 54px', color: ink.soft });
  const total = state.options.balls;
  const step = Math.min(34, 480 / total);
  for (let i = 0; i < total; i++) {
    context.beginPath();
    context.arc(286 + i * step, 411, Math.min(13, step * 0.38), 0, 2 * Math.PI);
    context.fillStyle = i < left ? ink.accent : 'transparent';
    context.strokeStyle = i < left ? ink.accent : ink.line;
    context.lineWidth = 4;
    context.fill();
    context.stroke();
  }
  drawText(context, String(left), [width - 54, 434], { font: '800 64px', color: ink.text, align: 'right' });
  drawText(context, line, [64, 536], { font: '700 60px', color: ink.text, maxWidth: width - 128 });
}

export type LobbyButton = 'ready' | 'rotate' | 'seat0' | 'seat1' | 'seat2';

export const lobbySize = { width: 1024, height: 900 } as const;

const rowTop = 330;
const rowHeight = 112;
const readyButton: SheetButton<LobbyButton> = { id: 'ready', x: 512, y: 740, width: 448, height: 112 };
const rotateButton: SheetButton<LobbyButton> = { id: 'rotate', x: 64, y: 740, width: 424, height: 112 };
const seatIds = ['seat0', 'seat1', 'seat2'] as const;

/** Returns the seat of a button, or null if it has none. */
export const seatOfButton = (id: LobbyButton): number | null => {
  const seat = (seatIds as readonly string[]).indexOf(id);
  return seat < 0 ? null : seat;
};

/** Players in the order of their stations. */
const byStation = ({ state }: DisplayedMatch): readonly number[] =>
  state.players
    .map((_, player) => player)
    .sort((a, b) => (state.players[a]?.station ?? 0) - (state.players[b]?.station ?? 0));

/** The buttons that its reader may press: a place for each seat that is free or a bot's, and ready. */
export function lobbyButtons(standing: DisplayedMatch): readonly SheetButton<LobbyButton>[] {
  const { players, me } = standing;
  const places = byStation(standing).flatMap((player, row): SheetButton<LobbyButton>[] => {
    const person = players[player];
    const id = seatIds[player];
    if (!id || player === me || (person && !person.bot)) return [];
    return [{ id, x: 690, y: rowTop + row * rowHeight + 10, width: 270, height: rowHeight - 24 }];
  });
  return me === null ? places : [...places, rotateButton, readyButton];
}

/** Paints the sheet before and after a match: players, who is ready, the result. */
export function paintLobby(
  context: CanvasRenderingContext2D,
  standing: DisplayedMatch,
  hovered: LobbyButton | null,
): void {
  const { state, players, me, rotate } = standing;
  const { width, height } = lobbySize;
  paintCard(context, width, height);
  const over = state.phase === 'over';
  const { balls, seconds } = state.options;
  const middle = (text: string, y: number, writing: TextStyle) =>
    drawText(context, text, [width / 2, y], { ...writing, align: 'center' });
  const heading = over ? (state.end === 'time' ? 'Time is up' : 'All balls thrown') : 'Ball game';
  middle(heading, 88, { font: '700 44px', color: ink.soft });
  if (over) {
    const score = String(state.score);
    const rest = `of ${balls} caught`;
    const scoreWidth = textWidth(context, score, '800 170px');
    const left = (width - scoreWidth - 24 - textWidth(context, rest, '700 64px')) / 2;
    drawText(context, score, [left, 250], { font: '800 170px', color: ink.text });
    drawText(context, rest, [left + scoreWidth + 24, 250], { font: '700 64px', color: ink.soft });
  } else {
    const roles = 'Two players throw, one catches with the basket.';
    middle(roles, 172, { font: '600 46px', color: ink.text, maxWidth: width - 128 });
    const match = `${balls} balls, ${Math.round(seconds)} seconds, a point per catch`;
    middle(match, 240, { font: '600 42px', color: ink.soft });
  }
  for (const [row, player] of byStation(standing).entries()) {
    paintRow(context, standing, player, rowTop + row * rowHeight);
  }
  const waiting = waitingSentence(standing);
  if (waiting) middle(waiting, 702, { font: '700 38px', color: ink.accent, baseline: 'middle', maxWidth: width - 96 });
  const buttons = lobbyButtons(standing);
  const isReady = state.players[me ?? -1]?.ready ?? false;
  for (const button of buttons) {
    const lit = hovered === button.id;
    if (button.id === 'ready') {
      const label = isReady ? 'Wait for me' : over ? 'Play again' : 'Ready';
      paintButton(context, button, label, { primary: !isReady, hovered: lit, font: '800 54px' });
    } else if (button.id === 'rotate') {
      const label = `Swap roles: ${rotate ? 'on' : 'off'}`;
      paintButton(context, button, label, { hovered: lit, font: '700 42px' });
    } else paintButton(context, button, 'Play here', { hovered: lit, font: '700 38px' });
  }
  if (me === null) {
    const isFree = players.some((person) => person === null || person.bot);
    const text = isFree ? 'You are watching. Take a place to play.' : 'You are watching.';
    middle(text, 796, { font: '600 42px', color: ink.soft, baseline: 'middle' });
  }
}

function paintRow(context: CanvasRenderingContext2D, standing: DisplayedMatch, player: number, top: number): void {
  const { state, players, me } = standing;
  const { width } = lobbySize;
  const station = state.players[player]?.station ?? 0;
  const look = seatLooks[station];
  const person = players[player] ?? null;
  context.fillStyle = player === me ? 'rgba(255, 200, 97, 0.13)' : 'rgba(200, 216, 236, 0.07)';
  context.beginPath();
  context.roundRect(48, top, width - 96, rowHeight - 8, 24);
  context.fill();
  const middle = top + (rowHeight - 8) / 2;
  context.fillStyle = look?.color ?? ink.soft;
  context.beginPath();
  context.arc(108, middle, 34, 0, 2 * Math.PI);
  context.fill();
  const baseline = 'middle';
  const mark = { font: '800 40px', color: look?.ink ?? ink.text, align: 'center', baseline } as const;
  drawText(context, look?.mark ?? '', [108, middle + 3], mark);
  const name = person
    ? person.me && person.name !== ownName
      ? `${displayName(person)} · you`
      : displayName(person)
    : 'Free';
  const taken = person !== null && (!person.bot || player === me);
  const color = person ? ink.text : ink.soft;
  drawText(context, name, [164, middle - 20], { font: '700 42px', color, baseline, maxWidth: taken ? 520 : 500 });
  const catches = catchesOf(state, player);
  const role = roleTexts[station] ?? '';
  const scored = state.phase === 'over' && state.players[player]?.role === 'thrower';
  const under = scored ? `${role}: ${catches} caught` : role;
  drawText(context, under, [164, middle + 26], { font: '600 32px', color: ink.soft, baseline, maxWidth: 500 });
  if (!taken) return;
  const here = person?.presence === 'here';
  const ready = state.players[player]?.ready;
  const [status, tone] = !here ? ['Away', ink.warning] : ready ? ['✓ Ready', ink.good] : ['Not ready', ink.soft];
  drawText(context, status!, [width - 80, middle + 2], { font: '700 38px', color: tone!, align: 'right', baseline });
}
