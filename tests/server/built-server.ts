import { mkdirSync, mkdtempSync, renameSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { buildServer } from '../../scripts/build-server.mjs';

/**
 * Builds the server into a new folder that is laid out as the image is (deploy/Dockerfile), with a page of one line.
 * Child processes of tests run it (started-server.ts). Returns a function that deletes the folder.
 */
export default async function provideBuiltServer(): Promise<() => void> {
  const image = mkdtempSync(join(tmpdir(), 'threepoint-image-'));
  await buildServer(join(image, 'server'));
  renameSync(join(image, 'server/package.json'), join(image, 'package.json'));
  mkdirSync(join(image, 'dist'));
  writeFileSync(join(image, 'dist/index.html'), '<!doctype html><title>page</title>');
  symlinkSync(fileURLToPath(new URL('../../node_modules', import.meta.url)), join(image, 'node_modules'), 'junction');
  process.env.THREEPOINT_IMAGE = image;
  return () => rmSync(image, { recursive: true, force: true, maxRetries: 10 });
}
