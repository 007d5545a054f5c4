// npm run bench [-- --json FILE] [visit frames archery ball crowd allocations networks avatar] [--rounds N]: what a frame costs, by estimator and by stage, in
// headless Chromium. Named parts only are measured; all of them take an hour on two cores without a graphics device, "frames --rounds 3" minutes.
// npm run bench networks -- --device: WebGPU on the machine's graphics device instead of in software.
// Each part prints how long it took and is written to FILE when it is through; ratios of frames have intervals of 95 % confidence.
// npm run bench -- --allocations [ik paper learned mirror archery ball3 ball8 hands stillScene]: only what frames leave to the collector, and which
// functions leave it.
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { buildWhenStale } from './build.mjs';
import { ensureChromium } from './chromium.mjs';
import { ensureInstalled } from './installation.mjs';
import { main, root, run } from './run-command.mjs';

const vite = (...options) => run('npx', ['vite', 'build', '--logLevel', 'warn', ...options], { cwd: root });
/** Functions keep their names, and a map leads back to the sources. */
const readable = ['--minify', 'false', '--sourcemap'];

await main(async () => {
  const { values, positionals } = parseArgs({
    options: {
      json: { type: 'string' },
      allocations: { type: 'boolean' },
      rounds: { type: 'string' },
      device: { type: 'boolean' },
      avatar: { type: 'string' },
    },
    allowPositionals: true,
  });
  await ensureInstalled();
  await ensureChromium();
  if (values.allocations) {
    const { code } = await vite('--outDir', '.cache/bench-of-page', '--emptyOutDir', ...readable);
    if (code !== 0) return code;
  } else await buildWhenStale();
  const page = await vite('--config', 'bench/vite.config.ts', ...(values.allocations ? readable : []));
  if (page.code !== 0) return page.code;
  const measure = ['--import', 'tsx', 'bench/main.ts'];
  // Paths mean what they mean to the person who typed it.
  const from = process.env.INIT_CWD ?? process.cwd();
  if (values.json) measure.push('--json', resolve(from, values.json));
  if (values.avatar) measure.push('--avatar', resolve(from, values.avatar));
  if (values.rounds) measure.push('--rounds', values.rounds);
  if (values.allocations) measure.push('--allocations');
  if (values.device) measure.push('--device');
  measure.push(...positionals);
  const { code } = await run(process.execPath, measure, { cwd: root });
  return code;
});
