// npx tsx tools/avatars/build/main.ts [NAME…] [--quick] [--out DIR]: builds our own bodies, or those named; --quick:
// from cells twice as large, for a look.
import { mkdirSync, writeFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { figures } from './bodies';
import { buildBody } from './build-body';

const { values, positionals } = parseArgs({
  options: { quick: { type: 'boolean', default: false }, out: { type: 'string' } },
  allowPositionals: true,
});
const unknown = positionals.find((name) => !figures.some((figure) => figure.name === name));
if (unknown)
  throw new Error(`build:avatar: no body is called ${unknown} (${figures.map(({ name }) => name).join(', ')})`);
for (const figure of figures.filter(({ name }) => positionals.length === 0 || positionals.includes(name))) {
  const file = await buildBody(figure, (what) => console.log(`  ${what}`), values.quick ? 2 : 1);
  const target = values.out
    ? `${values.out}/${figure.name}.vrm`
    : fileURLToPath(new URL(`../../../public/avatars/${figure.name}.vrm`, import.meta.url));
  mkdirSync(dirname(target), { recursive: true });
  writeFileSync(target, file);
  console.log(`${target}: ${(file.byteLength / 1000).toFixed(0)} kB`);
}
