import type { GameDescription } from 'threepoint-games/all';

/** “Touch the lit targets” for servers and studies. */
export const touch = {
  players: 2,
  because: 'targets are touched by two',
  unmirrored: 'the targets have no mirror',
  questionnaire: {
    id: 'touch',
    title: 'Targets',
    source: 'Written for the tests: it asks about a game that no study has.',
    answer: { kind: 'likert', from: 1, to: 7 },
    questions: [{ id: 'reach', text: 'I could reach the targets.' }],
  },
  paperFigures: null,
  ends: ['all-touched'],
  phrases: {
    en: { ready: 'Touch the lit targets with your hands.', round: 'The targets could not be opened.' },
    de: { ready: 'Berühren Sie die leuchtenden Ziele.', round: 'Die Ziele konnten nicht geöffnet werden.' },
  },
  simulated: { attempts: 12, triers: 2 },
  rooms: {
    seconds: 30,
    createKind: async (seconds) => (await import('./touch-rooms')).touchRoomKind(seconds),
  },
} as const satisfies GameDescription;
