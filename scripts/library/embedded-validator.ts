let address: string | undefined;

/** Starts a worker that validates files of avatars, from the code of it that the published package contains. */
export async function startValidator(): Promise<Worker> {
  const { default: code } = await import('../../src/threepoint/avatar/file/avatar-check-worker?bundled');
  address ??= URL.createObjectURL(new Blob([code], { type: 'text/javascript' }));
  return new Worker(address, { type: 'module' });
}
