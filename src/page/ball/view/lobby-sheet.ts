import { Group } from 'three';
import { createSheet, type SheetSize } from '../../scene/boards/sheet';
import type { Quality } from '../../scene/renderer';
import type { DisplayedMatch } from './displayed-match';
import type { LobbyButton } from './lobby-drawing';
import { lobbyButtons, lobbySize, paintLobby } from './lobby-drawing';

const size: SheetSize = { ...lobbySize, metres: 1.3 };

/** The sheet in front of the player before and after a match, floor frame of the user. */
export function createLobbySheet(quality: Quality) {
  const object = new Group();
  object.name = 'lobby';
  object.position.z = -1.9;
  const sheet = createSheet<LobbyButton>(size, quality);
  object.add(sheet.mesh);
  return {
    object,
    /**
     * eyeHeight [m]: of the reader; `time` [s]: the page's. Hides itself during a match, and where `inRoom` is false.
     */
    show(match: DisplayedMatch, eyeHeight: number, time: number, inRoom: boolean): void {
      const { state, players, me, rotate, acting } = match;
      object.position.y = Math.max(0.75, eyeHeight - 0.16);
      if (state.phase === 'running' || !inRoom) {
        sheet.show(null, time);
        return;
      }
      const { phase, end, score, options } = state;
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
