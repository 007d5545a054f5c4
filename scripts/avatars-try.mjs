// npm run tool -- avatars:try DIR [--out OUT]: opens each avatar of a folder as the page does and writes OUT/NAME.png
// with fifteen postures (tools/avatars/try/postures.ts) from three sides and the first-person view. OUT/all.png shows
// all avatars waving. Prints the reason for each rejected file. OUT defaults to DIR/sheets.
import { mkdirSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import { basename, extname, join } from 'node:path';
import { ensureChromium } from './chromium.mjs';
import { readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { main, root, SetupError } from './run-command.mjs';

const usage = 'npm run tool -- avatars:try DIR [--out OUT]';

function options() {
  const { rest, out } = readOptions('avatars:try', usage, { paths: ['out'], rest: 'paths' }, ({ rest }) => {
    if (rest.length !== 1) throw new Error('a folder with avatars is needed');
    if (!statSync(rest[0], { throwIfNoEntry: false })?.isDirectory()) throw new Error(`${rest[0]}: no such folder`);
  });
  const [folder] = rest;
  return { folder, out: out ?? join(folder, 'sheets') };
}

/** Starts a server for the page and the folder's files on a free port of this machine. */
async function startServer(folder) {
  const { createServer } = await import('vite');
  const server = await createServer({
    root,
    configFile: join(root, 'vite.config.ts'),
    logLevel: 'warn',
    server: { host: '127.0.0.1', port: 0, hmr: false, watch: null, fs: { allow: [root, folder] } },
  });
  await server.listen();
  return server;
}

await main(async () => {
  const { folder, out } = options();
  await ensureInstalled();
  const executablePath = await ensureChromium();
  const files = readdirSync(folder).filter((name) => /\.(vrm|glb|fbx)$/i.test(name));
  if (files.length === 0) throw new SetupError(`avatars:try: ${folder} holds no .vrm, .glb or .fbx file`);
  mkdirSync(out, { recursive: true });
  const server = await startServer(folder);
  const { chromium } = await import('@playwright/test');
  const browser = await chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader'],
  });
  try {
    const page = await browser.newPage();
    // The server compiles the page's sources on request: on a busy machine that takes a minute.
    page.setDefaultTimeout(300_000);
    page.on('pageerror', (error) => console.log(`  ${error.message}`));
    await page.goto(`${server.resolvedUrls.local[0]}tools/avatars/try/sheet.html`);
    await page.waitForFunction(() => 'makeSheet' in window);
    const write = (name, picture) =>
      writeFileSync(join(out, `${name}.png`), Buffer.from(picture.split(',')[1], 'base64'));
    const all = [];
    for (const file of files.sort()) {
      const address = `/@fs/${join(folder, file).replace(/^\//, '')}`;
      const { picture, waving, refused, notes, loadMs } = await page.evaluate(
        ([address, name]) => window.makeSheet(address, name),
        [address, file],
      );
      write(basename(file, extname(file)), picture);
      if (waving) all.push(waving);
      console.log(refused ? `- ${refused}` : [`+ ${file} in ${Math.round(loadMs)} ms`, ...notes].join('; '));
    }
    if (all.length > 0) write('all', await page.evaluate((waving) => window.makeRow(waving), all));
  } finally {
    await browser.close();
    await server.close();
  }
  console.log(`${files.length} sheets in ${out}`);
  return 0;
});
