import type { GameDescription } from '../game-description';
import questionnaire from './questionnaire.json' with { type: 'json' };

/** Archery for servers and studies. A score would count for all of a group. */
export const archery = {
  players: 1,
  because: 'archery is played alone',
  unmirrored: null,
  questionnaire,
  paperFigures: { answers: 11, scores: 12 },
  ends: ['arrows', 'targets'],
  phrases: {
    en: {
      ready: 'Shoot up to five arrows at the four targets. Each target counts once; the farther, the more points.',
      round: 'The archery range could not be opened.',
    },
    de: {
      ready:
        'Schießen Sie bis zu fünf Pfeile auf die vier Zielscheiben. Jede Scheibe zählt einmal; je weiter entfernt, desto mehr Punkte.',
      round: 'Der Schießstand konnte nicht geöffnet werden.',
    },
  },
  simulated: { points: [5, 10, 15, 20], attempts: 5 },
  rooms: null,
} as const satisfies GameDescription;
