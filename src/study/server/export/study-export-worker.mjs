// The process of an export begins with JavaScript: it does not inherit a loader for TypeScript.
import { register } from 'tsx/esm/api';

register();
await import('./study-export-work.ts');
