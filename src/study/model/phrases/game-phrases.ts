import { type GameName, gameNames, games } from 'threepoint-games/all';

/** Returns one phrase of every game in a language, by its key. */
export function gamePhrases<Kind extends 'ready' | 'round'>(
  language: 'en' | 'de',
  kind: Kind,
): Readonly<Record<`${Kind}.${GameName}`, string>> {
  const phrases = {} as Record<`${Kind}.${GameName}`, string>;
  for (const name of gameNames) phrases[`${kind}.${name}`] = games[name].phrases[language][kind];
  return phrases;
}
