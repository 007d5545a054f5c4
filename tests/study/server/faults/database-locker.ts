// Another program that holds the write lock of a database: of the file that is its argument, from "lock" to "unlock".
import { DatabaseSync } from '@photostructure/sqlite';

const database = new DatabaseSync(process.argv[2] as string);
process.on('message', (what: 'lock' | 'unlock') => {
  database.exec(what === 'lock' ? 'BEGIN IMMEDIATE' : 'ROLLBACK');
  process.send?.(what);
});
process.send?.('ready');
