// node --import tsx scripts/security-table.ts: writes the tables of docs/security.md from tests/server/access-rows.ts.
import { readFileSync, writeFileSync } from 'node:fs';
import { withTables } from '../tests/server/access-rows';

const page = new URL('../docs/security.md', import.meta.url);
writeFileSync(page, withTables(readFileSync(page, 'utf8')));
