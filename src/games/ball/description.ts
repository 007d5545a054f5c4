import type { GameDescription } from '../game-description';
import questionnaire from './questionnaire.json' with { type: 'json' };

/** The ball game for servers and studies. In a study it waits for every seat. */
export const ball = {
  players: 3,
  because: 'the ball game is played by three',
  unmirrored: 'the ball game has no mirror',
  questionnaire,
  paperFigures: { answers: 13, scores: 14 },
  ends: ['balls'],
  phrases: {
    en: {
      ready:
        'Two of you throw balls, the third catches them with the basket. Every ball in the basket is a point for all three.',
      round: 'The ball court could not be opened.',
    },
    de: {
      ready:
        'Zwei von Ihnen werfen Bälle, die dritte Person fängt sie mit dem Korb. Jeder Ball im Korb ist ein Punkt für alle drei.',
      round: 'Das Ballspielfeld konnte nicht geöffnet werden.',
    },
  },
  simulated: { attempts: 20, triers: 2 },
  rooms: {
    seconds: 90,
    createKind: async (seconds) => (await import('./ball-room-kind')).ballRoomKind(seconds),
  },
} as const satisfies GameDescription;
