import { drawText, vrColors } from 'threepoint-ui/vr';
import {
  bottomButton,
  buttonGap,
  fullWidth,
  halfWidth,
  type MenuButton,
  type MenuSheet,
  menuMargin,
} from '../../activity/activity-menu';
import type { MatchBarActions } from '../panel/match-controls';
import { hideLabel, muteLabel, type OtherPlayer } from '../panel/other-players';
import { paintSeatMark } from '../view/seat-looks';

/** The top of the first player [pixels]. */
const playersTop = 124;
/** The height of each player: name, role and voice, two buttons [pixels]. */
export const playerHeight = 252;
const buttonsTop = 104;
const buttonsHeight = 88;

export interface PlayersSheetActions extends Pick<MatchBarActions['voices'], 'silence' | 'hide'> {
  close(): void;
}

/** The buttons of one player, at the same position in every row. */
function playerButtons(player: OtherPlayer, row: number, actions: PlayersSheetActions): readonly MenuButton[] {
  const { seat, silenced, hidden, muting } = player;
  const top = playersTop + row * playerHeight + buttonsTop;
  const hide: MenuButton = {
    id: `hide-${seat}`,
    label: hideLabel(player),
    at: [menuMargin + halfWidth + buttonGap, top, halfWidth, buttonsHeight],
    look: hidden ? 'chosen' : 'plain',
    act: () => actions.hide(seat, !hidden),
  };
  if (muting === 'none') return [hide];
  const mute: MenuButton = {
    id: `mute-${seat}`,
    label: muteLabel(player),
    at: [menuMargin, top, halfWidth, buttonsHeight],
    look: muting === 'off' ? 'off' : silenced ? 'chosen' : 'plain',
    act: () => actions.silence(seat, !silenced),
  };
  return [mute, hide];
}

/** Mark, name, role and voice of each player above their buttons. */
function drawPlayers(context: CanvasRenderingContext2D, players: readonly OtherPlayer[]): void {
  const baseline = 'middle';
  for (const [row, { name, station, role, status }] of players.entries()) {
    const top = playersTop + row * playerHeight;
    const left = menuMargin + 84;
    const maxWidth = fullWidth - 88;
    paintSeatMark(context, station, [menuMargin + 38, top + 46], 34);
    drawText(context, name, [left, top + 24], { font: '650 40px', color: vrColors.ink, baseline, maxWidth });
    const about = [role, status].filter(Boolean).join(' · ');
    drawText(context, about, [left, top + 70], {
      font: '500 28px',
      color: vrColors.inkSoft,
      baseline,
      maxWidth,
    });
  }
  if (players.length > 0) return;
  const alone = { font: '500 34px', color: vrColors.inkSoft, baseline } as const;
  drawText(context, 'You are alone here.', [menuMargin + 4, playersTop + 24], alone);
}

/** Lists the other players in the headset, with buttons to mute and to hide each. */
export const playersSheet = (players: readonly OtherPlayer[], actions: PlayersSheetActions): MenuSheet => ({
  heading: 'Other players',
  content: players,
  buttons: [
    ...players.flatMap((player, row) => playerButtons(player, row, actions)),
    bottomButton('close', 'Close', () => actions.close()),
  ],
  draw: (context) => drawPlayers(context, players),
});
