// What a thread begins with is JavaScript: of a loader for TypeScript that the process was started with, threads know nothing in Node 20.
import { register } from 'tsx/esm/api';

register();
await import('./study-export-work.ts');
