import { mkdirSync, writeFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { fileURLToPath } from 'node:url';
import { buildMannequin } from './mannequin';

const target = fileURLToPath(new URL('../../public/avatars/mannequin.vrm', import.meta.url));
const file = await buildMannequin((what) => console.log(`  ${what}`));
mkdirSync(dirname(target), { recursive: true });
writeFileSync(target, file);
console.log(`${target}: ${(file.byteLength / 1024).toFixed(0)} kB`);
