import { fileURLToPath } from 'node:url';

const game = fileURLToPath(new URL('./game/', import.meta.url));

/** What adding the third game changes outside its folder: an import and an entry in each registry. */
const additions = [
  { file: 'src/games/all-games.ts', from: 'description', before: 'export const games = {' },
  { file: 'src/page/shell/activity-registry.ts', from: 'touch', before: 'export const activities = [' },
] as const;

/** Adds the third game to both registries, in builds by Vite and by Rolldown and in the tests of this folder. */
export const thirdGame = {
  name: 'third-game',
  enforce: 'pre',
  transform(code: string, id: string) {
    const addition = additions.find(({ file }) => id.endsWith(file));
    if (!addition) return undefined;
    const { from, before } = addition;
    if (!code.includes(before)) throw new Error(`${id}: expected "${before}"`);
    const line = `import { touch } from '${game}${from}';`;
    return { code: `${line}\n${code.replace(before, `${before} touch,`)}`, map: null };
  },
} as const;
