// npx tsx tools/studio/main.ts: computes the light of the studio and writes it to its light map.
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { bakeLight } from './bake-light';
import { writePng } from './png';

const file = fileURLToPath(new URL('../../src/page/studio/room/light-map.png', import.meta.url));
const { width, height, pixels } = bakeLight();
const picture = writePng(width, height, pixels);
writeFileSync(file, picture);
console.log(`${file}: ${width} × ${height} texels, ${(picture.byteLength / 1000).toFixed(0)} kB`);
