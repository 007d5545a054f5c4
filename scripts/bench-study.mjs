// npm run bench:study [-- --participants 200 --seconds 60 --flush-ms 25 --json FILE]: measures concurrent remote
// participants of one study on one server process. --flush-ms delays each flush of the disk, by strace.
import { passedOn, readOptions, runAsScript } from './command-line.mjs';

const usage = 'npm run bench:study [-- --participants 200 --seconds 60 --flush-ms 25 --json FILE]';
const texts = ['participants', 'seconds', 'flush-ms'];

await runAsScript('bench/study-load.ts', () => {
  const given = readOptions('bench:study', usage, { texts: [...texts, 'json'] });
  return passedOn(given, texts, ['json']);
});
