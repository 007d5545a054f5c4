// npm run tool -- pictures: renews the pictures of the documents from the page as it is now. Look at each one before
// you commit it.
import { copyFileSync } from 'node:fs';
import { join } from 'node:path';
import { ensureInstalled } from './installation.mjs';
import { mainOf, root, run } from './run-command.mjs';
import { scriptOf } from './tool.mjs';

/** Files of docs/images by the screenshots that the nightly tests keep. */
const pictures = {
  'readme-archery': 'archery.jpg',
  'readme-motion-in': 'ghost.jpg',
  'docs-study-experimenter': 'study-experimenter.jpg',
};
const films = ['film-mirror', 'film-methods', 'film-archery', 'film-ball', 'film-phone'];

await mainOf(import.meta.url, async () => {
  await ensureInstalled();
  const { default: sharp } = await import('sharp');
  const screenshots = join(root, 'artifacts/screenshots');
  const sheets = join(root, 'artifacts/avatar-sheets');
  const images = join(root, 'docs/images');
  const saveAsJpeg = (from, name) => sharp(from).jpeg({ quality: 82 }).toFile(join(images, name));
  const playwright = ['playwright', 'test', '--project=nightly', 'readme-pictures', 'experimenter-page'];
  const tests = await run('npx', playwright, { env: { THREEPOINT_NIGHTLY: '1' } });
  if (tests.code !== 0) return tests.code;
  for (const [from, name] of Object.entries(pictures)) await saveAsJpeg(join(screenshots, `${from}.png`), name);
  for (const film of films) copyFileSync(join(screenshots, `${film}.webp`), join(images, `${film}.webp`));
  const bodies = await run(process.execPath, [scriptOf('avatars:try'), 'public/avatars', '--out', sheets]);
  if (bodies.code === 0) await saveAsJpeg(join(sheets, 'all.png'), 'bodies.jpg');
  return bodies.code;
});
