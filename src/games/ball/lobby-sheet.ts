import { Group } from 'three';
import { disposeTree } from '../../scene/dispose-tree';
import type { Quality } from '../../scene/renderer';
import { createSheet, type Sheet, type SheetSize } from '../sheet';
import { type LobbyButton, lobbyButtons, lobbySize, paintLobby, type Standing } from './board-drawing';

/** Before and after a match, in front of whoever plays; own floor frame. */
export interface LobbySheet extends Pick<Sheet<LobbyButton>, 'buttonAt' | 'setHovered'> {
  readonly object: Group;
  /** eyeHeight [m]: of whoever reads it. Hides itself during a match. */
  show(standing: Standing, eyeHeight: number): void;
  dispose(): void;
}

const size: SheetSize = { ...lobbySize, metres: 1.3 };

export function createLobbySheet(quality: Quality): LobbySheet {
  const object = new Group();
  object.name = 'lobby';
  object.position.z = -1.9;
  const sheet = createSheet<LobbyButton>(size, quality);
  object.add(sheet.mesh);
  return {
    object,
    show(standing, eyeHeight) {
      const { state, people, me, rotate } = standing;
      object.position.y = Math.max(0.75, eyeHeight - 0.16);
      if (state.phase === 'running') return sheet.show(null);
      const { phase, end, score, options, players } = state;
      sheet.show({
        key: JSON.stringify([
          phase,
          end,
          score,
          options,
          players.map(({ ready, role }) => [ready, role]),
          people,
          me,
          rotate,
        ]),
        buttons: lobbyButtons(standing),
        paint: (context, hovered) => paintLobby(context, standing, hovered),
      });
    },
    buttonAt: sheet.buttonAt,
    setHovered: sheet.setHovered,
    dispose() {
      object.removeFromParent();
      disposeTree(object);
    },
  };
}
