import { queryObjects, setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';

setFlagsFromString('--expose-gc');

/** Collects all that nothing refers to, now. */
export const collectGarbage = runInNewContext('gc') as () => void;

/**
 * Collects it, and gives the memory back that V8 would keep for new objects: up to 45 MB after a crowd, more or less by chance. A query of
 * the heap does so, as V8 says in Heap::CollectAllAvailableGarbage; a collection does not.
 */
export function releaseMemory(): void {
  collectGarbage();
  queryObjects(class None {}, { format: 'count' });
}
