// npm run bench [-- --json FILE] [visit counts frames archery ball crowd allocations networks avatar] [--rounds N]:
// measures the time of a frame by estimator and by stage, in headless Chromium. Without names it measures every part,
// which takes an hour on two cores without a GPU; "frames --rounds 3" takes minutes. "counts" counts what each world
// draws, and fails where a budget is exceeded. npm run bench networks -- --device: uses WebGPU on the machine's GPU
// instead of in software. Each part prints its duration and is written to FILE when it ends; ratios of frames have 95 %
// confidence intervals. npm run bench -- --allocations [ik paper learned mirror archery ball3 ball8 hands stillScene]:
// measures only the garbage that frames allocate, and the functions that allocate it.
import { parseArgs } from 'node:util';
import { buildWhenStale } from './build.mjs';
import { ensureChromium } from './chromium.mjs';
import { ensureInstalled } from './installation.mjs';
import { main, root, run, runProgram, typedPath } from './run-command.mjs';

const vite = (...options) => run('npx', ['vite', 'build', '--logLevel', 'warn', ...options], { cwd: root });
/** The build options of benchmarks: function names and source maps are kept. */
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
  const measure = [];
  if (values.json) measure.push('--json', typedPath(values.json));
  if (values.avatar) measure.push('--avatar', typedPath(values.avatar));
  if (values.rounds) measure.push('--rounds', values.rounds);
  if (values.allocations) measure.push('--allocations');
  if (values.device) measure.push('--device');
  measure.push(...positionals);
  return runProgram('bench/main.ts', measure);
});
