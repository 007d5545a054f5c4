import { createHash } from 'node:crypto';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

/** The software that drew the bodies of a study. */
export interface Software {
  readonly name: string;
  readonly version: string;
  /** The files of the networks, with their hashes. */
  readonly weights: readonly { readonly file: string; readonly sha256: string }[];
}

const isWeights = (file: string): boolean => /\.(onnx|bin)$/.test(file);

/**
 * Returns this program, its version by the `manifest` (a package.json), and the networks below `pageDirectory`, which
 * may have none.
 */
export function readSoftwareVersion(pageDirectory: string, manifest: URL): Software {
  const { version } = JSON.parse(readFileSync(manifest, 'utf8')) as Software;
  const models = join(pageDirectory, 'models');
  const files = existsSync(models) ? readdirSync(models).filter(isWeights).toSorted() : [];
  const weights = files.map((file) => ({
    file: `models/${file}`,
    sha256: createHash('sha256')
      .update(readFileSync(join(models, file)))
      .digest('hex'),
  }));
  return { name: 'threepoint', version, weights };
}
