import { Group } from 'three';
import type { HostedGame } from 'threepoint-rooms/room';
import { drawText, type TextStyle, textWidth } from 'threepoint-ui/vr';
import { ink, paintCard } from '../../scene/boards/board-style';
import { createSheet, paintButton, type SheetButton } from '../../scene/boards/sheet';
import type { Quality } from '../../scene/renderer';
import type { SeatedGame } from '../match/seated-game';
import { type DisplayedMatch, displayName, ownName } from './displayed-match';
import { paintSeatMark } from './seat-looks';
import { waitingSentence } from './waiting-sentence';

export type LobbyButton = 'ready' | 'option' | `seat${number}`;
export const lobbySize = { width: 1024, height: 900 } as const;
const rowTop = 330;
const rowHeight = 112;
const readyButton: SheetButton<LobbyButton> = { id: 'ready', x: 512, y: 740, width: 448, height: 112 };
const optionButton: SheetButton<LobbyButton> = { id: 'option', x: 64, y: 740, width: 424, height: 112 };

/** Returns the seat of a button, or null if it has none. */
export const seatOfButton = (id: LobbyButton): number | null => (id.startsWith('seat') ? Number(id.slice(4)) : null);

/** Players in the order of their stations. */
const byStation = <Game extends HostedGame>({ stationOf }: SeatedGame<Game>, state: Game['state']): readonly number[] =>
  state.players.map((_, player) => player).sort((a, b) => stationOf(state, a) - stationOf(state, b));

/** Returns the buttons for the reader: one for each seat that is free or a bot's, the option, and ready. */
export function lobbyButtons<Game extends HostedGame>(
  game: SeatedGame<Game>,
  { state, players, me }: DisplayedMatch<Game['state']>,
): readonly SheetButton<LobbyButton>[] {
  const seats = byStation(game, state).flatMap((player, row): SheetButton<LobbyButton>[] => {
    const person = players[player];
    if (player === me || (person && !person.bot)) return [];
    return [{ id: `seat${player}`, x: 690, y: rowTop + row * rowHeight + 10, width: 270, height: rowHeight - 24 }];
  });
  if (me === null) return seats;
  return game.option ? [...seats, optionButton, readyButton] : [...seats, readyButton];
}

/** The sheet before and after a match of a game for at most three players: players, who is ready, the result. */
export class LobbySheet<Game extends HostedGame> {
  readonly object = new Group();
  readonly #game: SeatedGame<Game>;
  readonly sheet: ReturnType<typeof createSheet<LobbyButton>>;

  constructor(game: SeatedGame<Game>, quality: Quality) {
    this.#game = game;
    this.sheet = createSheet<LobbyButton>({ ...lobbySize, metres: 1.3 }, quality);
    this.object.name = 'lobby';
    this.object.position.z = -1.9;
    this.object.add(this.sheet.mesh);
  }

  /**
   * eyeHeight [m]: of the reader; `time` [s]: the page's. Hides itself during a match, and where `inRoom` is false.
   */
  show(match: DisplayedMatch<Game['state']>, eyeHeight: number, time: number, inRoom: boolean): void {
    const { state, players, me, readyByItself } = match;
    this.object.position.y = Math.max(0.75, eyeHeight - 0.16);
    if (state.phase === 'running' || !inRoom) {
      this.sheet.show(null, time);
      return;
    }
    const game = this.#game;
    const seats = state.players.map(({ ready }, seat) => [ready, game.stationOf(state, seat)]);
    this.sheet.show(
      {
        key: JSON.stringify([
          state.phase,
          game.figures(state),
          game.lobby(state),
          seats,
          players,
          me,
          game.option?.isOn(state),
          readyByItself,
        ]),
        buttons: lobbyButtons(game, match),
        paint: (context, hovered) => this.#paint(context, match, hovered),
      },
      time,
    );
  }

  #paint(context: CanvasRenderingContext2D, match: DisplayedMatch<Game['state']>, hovered: LobbyButton | null): void {
    const { state, players, me } = match;
    const { width, height } = lobbySize;
    paintCard(context, width, height);
    const over = state.phase === 'over';
    const { heading, about, result } = this.#game.lobby(state);
    const middle = (text: string, y: number, writing: TextStyle) =>
      drawText(context, text, [width / 2, y], { ...writing, align: 'center' });
    middle(heading, 88, { font: '700 44px', color: ink.soft });
    if (over) {
      const score = String(this.#game.figures(state).score);
      const scoreWidth = textWidth(context, score, '800 170px');
      const left = (width - scoreWidth - 24 - textWidth(context, result, '700 64px')) / 2;
      drawText(context, score, [left, 250], { font: '800 170px', color: ink.text });
      drawText(context, result, [left + scoreWidth + 24, 250], { font: '700 64px', color: ink.soft });
    } else {
      middle(about[0], 172, { font: '600 46px', color: ink.text, maxWidth: width - 128 });
      middle(about[1], 240, { font: '600 42px', color: ink.soft });
    }
    for (const [row, player] of byStation(this.#game, state).entries()) {
      this.#paintRow(context, match, player, rowTop + row * rowHeight);
    }
    const waiting = waitingSentence(this.#game, match);
    if (waiting)
      middle(waiting, 702, { font: '700 38px', color: ink.accent, baseline: 'middle', maxWidth: width - 96 });
    for (const button of lobbyButtons(this.#game, match))
      this.#paintButton(context, match, button, hovered === button.id);
    if (me === null) {
      const isFree = players.some((person) => person === null || person.bot);
      const text = isFree ? 'You are watching. Take a seat to play.' : 'You are watching.';
      middle(text, 796, { font: '600 42px', color: ink.soft, baseline: 'middle' });
    }
  }

  #paintButton(
    context: CanvasRenderingContext2D,
    { state, me }: DisplayedMatch<Game['state']>,
    button: SheetButton<LobbyButton>,
    hovered: boolean,
  ): void {
    const { option } = this.#game;
    if (button.id === 'ready') {
      const isReady = state.players[me ?? -1]?.ready ?? false;
      const label = isReady ? 'Wait for me' : state.phase === 'over' ? 'Play again' : 'Ready';
      paintButton(context, button, label, { primary: !isReady, hovered, font: '800 54px' });
    } else if (button.id === 'option') {
      const label = `${option?.shortLabel}: ${option?.isOn(state) ? 'on' : 'off'}`;
      paintButton(context, button, label, { hovered, font: '700 42px' });
    } else paintButton(context, button, 'Play here', { hovered, font: '700 38px' });
  }

  #paintRow(
    context: CanvasRenderingContext2D,
    { state, players, me }: DisplayedMatch<Game['state']>,
    player: number,
    top: number,
  ): void {
    const { width } = lobbySize;
    const station = this.#game.stationOf(state, player);
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
    const role = this.#game.roles[station] ?? '';
    const result = state.phase === 'over' ? this.#game.resultOf(state, player) : null;
    const under = result === null ? role : `${role}: ${result}`;
    drawText(context, under, [164, middle + 26], { font: '600 32px', color: ink.soft, baseline, maxWidth: 500 });
    if (!taken) return;
    const here = person?.presence === 'here';
    const ready = state.players[player]?.ready;
    const [status, tone] = !here ? ['Away', ink.warning] : ready ? ['✓ Ready', ink.good] : ['Not ready', ink.soft];
    drawText(context, status!, [width - 80, middle + 2], { font: '700 38px', color: tone!, align: 'right', baseline });
  }
}
