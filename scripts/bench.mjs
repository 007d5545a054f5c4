// npm run tool -- bench: measures the page in headless Chromium, part by part. Without names it measures every part,
// which takes half an hour on two cores without a GPU; "frames --rounds 3" takes minutes. "counts" counts what each
// world draws, and fails where a budget is exceeded. --device uses WebGPU on the machine's GPU instead of in software.
// Each part is written to FILE when it ends; ratios of frames have 95 % confidence intervals.
import { buildWhenStale } from './build.mjs';
import { ensureChromium } from './chromium.mjs';
import { readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { main, root, run, runProgram } from './run-command.mjs';

const usage =
  'npm run tool -- bench [--json FILE] [visit counts frames crowd allocations networks avatar] [--rounds N] [--device] [--avatar FILE]';

await main(async () => {
  const known = { texts: ['rounds'], paths: ['json', 'avatar'], flags: ['device'], rest: 'words' };
  const given = readOptions('bench', usage, known);
  await ensureInstalled();
  await ensureChromium();
  await buildWhenStale();
  const vite = ['vite', 'build', '--logLevel', 'warn', '--config', 'bench/vite.config.ts'];
  const { code } = await run('npx', vite, { cwd: root });
  return code || runProgram('bench/main.ts', [JSON.stringify(given)]);
});
