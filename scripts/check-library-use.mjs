// Uses the packed packages as their users do, in an empty folder outside the repository. Compiles the consumers in
// examples/ against them, with the module resolution of bundlers and of Node, strictly and with declarations checked;
// runs the programs of Node there. Checks that what is internal cannot be named.
import { copyFileSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { build } from 'esbuild';
import { rolldown } from 'rolldown';
import { packages } from './build-packages.mjs';
import { main, outputOf, root, run, SetupError } from './run-command.mjs';

const folder = mkdtempSync(join(tmpdir(), 'threepoint-consumer-'));
/** What consumers install beside the packages, in the versions of this repository. */
const beside = [
  ...['three', '@types/three', '@pixiv/three-vrm', 'onnxruntime-web', 'react', '@types/react', '@react-three/fiber'],
  ...['typescript', '@types/node'],
];
const resolutions = [
  { module: 'preserve', moduleResolution: 'bundler' },
  { module: 'node16', moduleResolution: 'node16' },
];

/** The consumers, and the types of its surroundings that each may use. */
const consumers = { 'consumer.ts': [], 'rooms-consumer.ts': [], 'relay-consumer.ts': ['node'] };

/** Packs the packages and installs them with what consumers install beside them. */
async function install() {
  for (const [name, { folder: built }] of Object.entries(packages)) {
    const pack = ['pack', join(root, built), '--pack-destination', folder];
    await outputOf('npm', pack, `${name} could not be packed`);
  }
  const tarballs = readdirSync(folder).filter((file) => file.endsWith('.tgz'));
  writeFileSync(join(folder, 'package.json'), '{ "type": "module" }');
  const exact = beside.map((name) => {
    const { version } = JSON.parse(readFileSync(join(root, 'node_modules', name, 'package.json'), 'utf8'));
    return `${name}@${version}`;
  });
  const options = ['--prefix', folder, '--no-audit', '--no-fund', '--prefer-offline'];
  const files = tarballs.map((file) => join(folder, file));
  await outputOf('npm', ['install', ...options, ...files, ...exact], 'the packages could not be installed');
}

/**
 * Errors in three-vrm's declarations, which are ignored: they import without the extensions Node's resolution requires.
 */
const foreign = /^[^(]*\bnode_modules[\\/]@pixiv[\\/]/;

/** Returns the compiler's errors in the package and in the consumer. */
async function compile(config) {
  const compiler = join(folder, 'node_modules/typescript/bin/tsc');
  const { code, output } = await run(process.execPath, [compiler, '-p', config], { capture: true });
  const faults = output.split(/\n(?=\S)/).filter((fault) => fault.trim() !== '' && !foreign.test(fault));
  if (code !== 0 && !/error TS/.test(output)) throw new SetupError(`The compiler broke down:\n${output}`);
  return faults;
}

/** What a page cannot name: each line must be an error. */
const internalUses = [
  "export type * from 'threepoint/core';",
  "export type * from 'threepoint/math';",
  "export type * from 'threepoint/files';",
  "export type * from 'threepoint/internal';",
  "export type * from 'threepoint/internal/three';",
  "export type * from 'threepoint-rooms/internal';",
  "export type * from 'threepoint-rooms/host';",
  'body.tick(0);',
  'body.solve(null);',
  'body.warmUp([]);',
  "new Body({ estimator: 'paper' });",
  'new Body({ clock: null });',
  'new Body({ profiler: null });',
];

/** What the snippets of the READMEs leave out. */
const surroundings = `
import type { Camera, Scene, WebGLRenderer } from 'three';
import type { Recording, TrackedPose } from 'threepoint';
import type { BodyTracker } from 'threepoint/three';
declare global {
  const renderer: WebGLRenderer;
  const scene: Scene;
  const camera: Camera;
  const session: XRSession;
  const recording: Recording;
  const tracker: BodyTracker;
  const time: number;
  const [head, leftHand, rightHand]: readonly [TrackedPose, TrackedPose, TrackedPose];
  const channel: RTCDataChannel;
  const peer: string;
  const mine: Map<string, string>;
}
`;

/** Compiles the snippets of the packages' READMEs strictly, each as a module. */
async function compileSnippets() {
  const files = ['surroundings.ts'];
  writeFileSync(join(folder, files[0]), surroundings);
  for (const name of ['threepoint', 'threepoint-rooms']) {
    const readme = readFileSync(join(folder, 'node_modules', name, 'README.md'), 'utf8');
    const snippets = [...readme.matchAll(/^```[jt]s\n([\s\S]*?)^```/gm)].map(([, code]) => code);
    for (const [number, code] of snippets.entries()) {
      files.push(`snippet-${name}-${number}.ts`);
      const typed = code.replace('(timeMs, frame) =>', '(timeMs: number, frame: XRFrame) =>');
      // The argument of an animation loop has its type from three.js; a function of the page states it.
      writeFileSync(join(folder, files.at(-1)), `${/const draw = /.test(code) ? typed : code}\nexport {};\n`);
    }
  }
  await compileFiles('the snippets of the READMEs', files, ['webxr', 'three']);
}

/** Compiles uses of what is internal; the compiler reports those that it accepts. */
async function compileInternalUses() {
  const lines = internalUses.map((use) => `// @ts-expect-error ${use}\n${use}`);
  const code = ["import { Body } from 'threepoint';", 'declare const body: Body;', ...lines].join('\n');
  writeFileSync(join(folder, 'internal-uses.ts'), code);
  await compileConsumer('internal-uses.ts', []);
}

const compileConsumer = (consumer, types) => compileFiles(consumer, [consumer], types);

/** Compiles files against the installed packages, as bundlers and as Node resolve modules. `what`: for messages. */
async function compileFiles(what, files, types) {
  for (const resolution of resolutions) {
    const config = join(folder, `tsconfig.${files[0]}.${resolution.moduleResolution}.json`);
    const compilerOptions = {
      ...resolution,
      ...{ target: 'es2022', lib: ['es2022', 'dom', 'dom.iterable'], types, noEmit: true },
      ...{ strict: true, exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true, skipLibCheck: false },
    };
    writeFileSync(config, JSON.stringify({ compilerOptions, files }));
    const faults = await compile(config);
    if (faults.length > 0) {
      throw new SetupError(
        `${what} with moduleResolution ${resolution.moduleResolution} does not compile:\n${faults.join('\n')}`,
      );
    }
  }
}

async function runProgram(name) {
  const program = join(folder, name);
  copyFileSync(join(root, 'examples', name), program);
  await outputOf(process.execPath, [program], `${name}, a program of Node, fails`);
}

/**
 * Checks that bundlers which ignore URLs in code keep the weights; a page without them stays with inverse kinematics.
 */
async function bundleWeights() {
  const program = join(folder, 'weights.mjs');
  writeFileSync(
    program,
    "import { loadLearned } from 'threepoint';\nif ((await loadLearned()).provider !== 'plain') process.exit(1);\n",
  );
  const out = (bundler) => join(folder, `bundled-by-${bundler}`);
  await build({ entryPoints: [program], outdir: out('esbuild'), bundle: true, format: 'esm', splitting: true });
  const bundle = await rolldown({ input: program, logLevel: 'silent' });
  await bundle.write({ dir: out('rolldown') });
  for (const bundler of ['esbuild', 'rolldown']) {
    const fault = `A bundle by ${bundler} does not load the learned network`;
    await outputOf(process.execPath, [join(out(bundler), 'weights.js')], fault);
  }
}

/**
 * Checks that a server which renders pages can import every entry for them: none may touch `window` before it is used.
 */
async function importWithoutBrowser() {
  const entries = Object.keys(packages).flatMap((name) => {
    const { exports } = JSON.parse(readFileSync(join(folder, 'node_modules', name, 'package.json'), 'utf8'));
    const code = Object.entries(exports).filter(([, target]) => target.default && !target.default.includes('*'));
    return code.map(([entry]) => join(name, entry));
  });
  const imports = entries.map((entry) => `import '${entry}';`);
  const program = join(folder, 'without-browser.mjs');
  writeFileSync(program, imports.join('\n'));
  await outputOf(process.execPath, [program], 'An entry cannot be imported without a browser');
}

await main(async () => {
  try {
    await install();
    for (const [consumer, types] of Object.entries(consumers)) {
      copyFileSync(join(root, 'examples', consumer), join(folder, consumer));
      await compileConsumer(consumer, types);
    }
    await compileInternalUses();
    await compileSnippets();
    for (const program of ['in-node.mjs', 'rooms-in-node.mjs']) await runProgram(program);
    await bundleWeights();
    await importWithoutBrowser();
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});
