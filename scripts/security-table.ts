// node --import tsx scripts/security-table.ts: writes the lists of docs/security.md from tests/server/access-rows.ts.
import { readFileSync, writeFileSync } from 'node:fs';
import { withLists } from '../tests/server/access-rows';

const page = new URL('../docs/security.md', import.meta.url);
writeFileSync(page, withLists(readFileSync(page, 'utf8')));
