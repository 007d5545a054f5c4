// npm run bench [-- --json FILE]: what a frame costs, by estimator and by stage, in headless Chromium.
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { buildWhenStale } from './build.mjs';
import { ensureChromium } from './chromium.mjs';
import { ensureInstalled } from './installation.mjs';
import { main, root, run } from './run-command.mjs';

await main(async () => {
  const { values } = parseArgs({ options: { json: { type: 'string' } } });
  await ensureInstalled();
  await ensureChromium();
  await buildWhenStale();
  const page = await run('npx', ['vite', 'build', '--config', 'bench/vite.config.ts', '--logLevel', 'warn'], {
    cwd: root,
  });
  if (page.code !== 0) return page.code;
  const measure = ['--import', 'tsx', 'bench/main.ts'];
  // The path means what it means to the person who typed it.
  if (values.json) measure.push('--json', resolve(process.env.INIT_CWD ?? process.cwd(), values.json));
  const { code } = await run(process.execPath, measure, { cwd: root });
  return code;
});
