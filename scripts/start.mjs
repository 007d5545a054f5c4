import { buildWhenStale } from './build.mjs';
import { ensureInstalled } from './installation.mjs';
import { main, SetupError } from './run-command.mjs';

await main(async () => {
  await ensureInstalled();
  if (!process.argv.includes('--help')) await buildWhenStale();
  // tsx is resolved here, because it may just have been installed.
  const { register } = await import('tsx/esm/api');
  register();
  try {
    await import('../server/main.ts');
  } catch (error) {
    if (!/EMFILE|ENFILE/.test(`${error.code} ${error.message}`)) throw error;
    throw new SetupError('The server may not have more files open. Raise the limit: ulimit -n 1024.');
  }
});
