// A thread begins with JavaScript: threads of Node 20 do not inherit a loader for TypeScript.
import { register } from 'tsx/esm/api';

register();
await import('./study-thread-work.ts');
