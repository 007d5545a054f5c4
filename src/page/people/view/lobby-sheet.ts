import { Group } from 'three';
import { catchesOf } from 'threepoint-games/ball';
import { drawText, type TextStyle, textWidth } from 'threepoint-ui/vr';
import { waitingSentence } from '../../ball/view/match-texts';
import { ink, paintCard } from '../../scene/boards/board-style';
import { createSheet, paintButton, type SheetButton } from '../../scene/boards/sheet';
import type { Quality } from '../../scene/renderer';
import { type DisplayedMatch, displayName, ownName } from './displayed-match';
import { paintSeatMark, roleTexts } from './seat-looks';

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
export function lobbyButtons(match: DisplayedMatch): readonly SheetButton<LobbyButton>[] {
  const { players, me } = match;
  const places = byStation(match).flatMap((player, row): SheetButton<LobbyButton>[] => {
    const person = players[player];
    const id = seatIds[player];
    if (!id || player === me || (person && !person.bot)) return [];
    return [{ id, x: 690, y: rowTop + row * rowHeight + 10, width: 270, height: rowHeight - 24 }];
  });
  return me === null ? places : [...places, rotateButton, readyButton];
}

/** Paints the sheet before and after a match: players, who is ready, the result. */
function paintLobby(context: CanvasRenderingContext2D, match: DisplayedMatch, hovered: LobbyButton | null): void {
  const { state, players, me } = match;
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
    const terms = `${balls} balls, ${Math.round(seconds)} seconds, a point per catch`;
    middle(terms, 240, { font: '600 42px', color: ink.soft });
  }
  for (const [row, player] of byStation(match).entries()) {
    paintRow(context, match, player, rowTop + row * rowHeight);
  }
  const waiting = waitingSentence(match);
  if (waiting) middle(waiting, 702, { font: '700 38px', color: ink.accent, baseline: 'middle', maxWidth: width - 96 });
  const buttons = lobbyButtons(match);
  const isReady = state.players[me ?? -1]?.ready ?? false;
  for (const button of buttons) {
    const lit = hovered === button.id;
    if (button.id === 'ready') {
      const label = isReady ? 'Wait for me' : over ? 'Play again' : 'Ready';
      paintButton(context, button, label, { primary: !isReady, hovered: lit, font: '800 54px' });
    } else if (button.id === 'rotate') {
      const label = `Swap roles: ${state.rotate ? 'on' : 'off'}`;
      paintButton(context, button, label, { hovered: lit, font: '700 42px' });
    } else paintButton(context, button, 'Play here', { hovered: lit, font: '700 38px' });
  }
  if (me === null) {
    const isFree = players.some((person) => person === null || person.bot);
    const text = isFree ? 'You are watching. Take a place to play.' : 'You are watching.';
    middle(text, 796, { font: '600 42px', color: ink.soft, baseline: 'middle' });
  }
}

function paintRow(context: CanvasRenderingContext2D, match: DisplayedMatch, player: number, top: number): void {
  const { state, players, me } = match;
  const { width } = lobbySize;
  const station = state.players[player]?.station ?? 0;
  const person = players[player] ?? null;
  context.fillStyle = player === me ? 'rgba(255, 200, 97, 0.13)' : 'rgba(200, 216, 236, 0.07)';
  context.beginPath();
  context.roundRect(48, top, width - 96, rowHeight - 8, 24);
  context.fill();
  const middle = top + (rowHeight - 8) / 2;
  paintSeatMark(context, station, [108, middle], 34);
  const baseline = 'middle';
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

/** Creates the sheet in front of the player before and after a match, floor frame of the user. */
export function createLobbySheet(quality: Quality) {
  const object = new Group();
  object.name = 'lobby';
  object.position.z = -1.9;
  const sheet = createSheet<LobbyButton>({ ...lobbySize, metres: 1.3 }, quality);
  object.add(sheet.mesh);
  return {
    object,
    /**
     * eyeHeight [m]: of the reader; `time` [s]: the page's. Hides itself during a match, and where `inRoom` is false.
     */
    show(match: DisplayedMatch, eyeHeight: number, time: number, inRoom: boolean): void {
      const { state, players, me, acting } = match;
      object.position.y = Math.max(0.75, eyeHeight - 0.16);
      if (state.phase === 'running' || !inRoom) {
        sheet.show(null, time);
        return;
      }
      const { phase, end, score, rotate, options } = state;
      sheet.show(
        {
          key: JSON.stringify([
            phase,
            end,
            score,
            options,
            state.players.map(({ ready, role }) => [ready, role]),
            players,
            me,
            rotate,
            acting,
          ]),
          buttons: lobbyButtons(match),
          paint: (context, hovered) => paintLobby(context, match, hovered),
        },
        time,
      );
    },
    buttonAt: sheet.buttonAt,
    setHovered: sheet.setHovered,
  };
}

export type LobbySheet = ReturnType<typeof createLobbySheet>;
