import { startNodeWorker } from '../../src/threepoint/avatar/file/node-worker';

let address: string | undefined;

/** Starts a worker that validates files of avatars, from the code of it that the published package contains. */
export async function startValidator(): Promise<Worker> {
  const { default: code } = await import('../../src/threepoint/avatar/file/avatar-check-worker?bundled');
  const thread = startNodeWorker(new TextEncoder().encode(code));
  if (thread) return thread;
  address ??= URL.createObjectURL(new Blob([code], { type: 'text/javascript' }));
  return new Worker(address, { type: 'module' });
}
