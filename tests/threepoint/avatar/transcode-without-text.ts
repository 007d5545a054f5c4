// Run by ktx2.test.ts in a Node process that compiles no text, as a page under our policy. Prints the pixels of a
// picture that the Basis transcoder unpacks.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { runInThisContext } from 'node:vm';
import { functionOfText } from 'threepoint/avatar/decoders/basis-functions';

const folder = new URL('../../../node_modules/three/examples/jsm/libs/basis/', import.meta.url);
const script = readFileSync(new URL('basis_transcoder.js', folder), 'utf8').replace(/if \(typeof exports[\s\S]*$/, '');
const compiles = (() => {
  try {
    return new Function('return true')() as boolean;
  } catch {
    return false;
  }
})();
if (!process.argv.includes('--as-it-is')) Object.assign(globalThis, { Function: functionOfText });
const rgba32 = 13;

async function transcode() {
  const makeBasis = runInThisContext(`(function (require, __dirname) {${script}\nreturn BASIS; })`);
  const require = createRequire(import.meta.url);
  const wasmBinary = readFileSync(new URL('basis_transcoder.wasm', folder));
  const basis = await makeBasis(require, '.')({ wasmBinary });
  basis.initializeBasis();
  const file = new basis.KTX2File(new Uint8Array(Buffer.from(process.argv[2]!, 'base64')));
  file.startTranscoding();
  const pixels = new Uint8Array(file.getImageTranscodedSizeInBytes(0, 0, 0, rgba32));
  file.transcodeImage(pixels, 0, 0, 0, rgba32, 0, -1, -1);
  const size = [file.getWidth(), file.getHeight()];
  file.close();
  file.delete();
  const complaints = [() => file.getWidth(), () => new basis.KTX2File()].map((call) => {
    try {
      return String(call());
    } catch (error) {
      return String(error);
    }
  });
  return { size, pixels: [...pixels], complaints };
}

const told = await transcode().catch((error: unknown) => ({ error: String(error) }));
console.log(JSON.stringify({ compiles, ...told }));
