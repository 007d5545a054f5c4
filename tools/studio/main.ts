// npx tsx tools/studio/main.ts: computes the light of the studio and writes it to its light map.
import { fileURLToPath } from 'node:url';
import sharp from 'sharp';
import { bakeLight } from './bake-light';

const file = fileURLToPath(new URL('../../src/page/studio/room/light-map.png', import.meta.url));
const { width, height, pixels } = bakeLight();
const picture = sharp(pixels, { raw: { width, height, channels: 3 } });
const { size } = await picture.png({ compressionLevel: 9, adaptiveFiltering: true }).toFile(file);
console.log(`${file}: ${width} × ${height} texels, ${(size / 1000).toFixed(0)} kB`);
