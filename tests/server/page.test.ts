import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { brotliCompressSync, brotliDecompressSync, gunzipSync, gzipSync } from 'node:zlib';
import { describe, expect, onTestFinished, test } from 'vitest';
import { createPageHandler, type PageOptions } from '../../server/page-handler';
import { directoryWith } from '../temporary-directory';
import { ask } from './running-server';
import { servePage } from './served-page';

const wasm = Buffer.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0]);
const site = {
  'index.html': '<!doctype html><title>page</title>',
  'assets/main-3f2a.js': 'export {};',
  'assets/runtime-77aa.wasm': wasm,
  'assets/runtime-77aa.wasm.br': brotliCompressSync(wasm),
  'assets/runtime-77aa.wasm.gz': gzipSync(wasm),
  'models/learned.onnx': 'weights',
  'models/learned.json': '{}',
  'avatars/mannequin.vrm': 'glTF',
  'manifest.webmanifest': '{}',
  'sw.js': 'self.keptFiles=[];',
  '.source-hash': 'secret',
};

async function served(files: Readonly<Record<string, string | Buffer>> = site, options: PageOptions = {}) {
  const directory = directoryWith(files);
  const server = await servePage(directory, options);
  onTestFinished(() => server.close());
  return { origin: `http://127.0.0.1:${server.port}`, directory };
}

describe('the page', () => {
  test('is found at the root, with a query or without', async () => {
    const { origin } = await served();
    for (const path of ['/', '/?ep=webgpu', '/index.html']) {
      const { status, headers, body } = await ask(origin, path);
      expect(status).toBe(200);
      expect(headers['content-type']).toBe('text/html; charset=utf-8');
      expect(body.toString()).toBe(site['index.html']);
    }
  });

  test.each([
    ['/assets/runtime-77aa.wasm', 'application/wasm'],
    ['/models/learned.onnx', 'application/octet-stream'],
    ['/models/learned.json', 'application/json; charset=utf-8'],
    ['/avatars/mannequin.vrm', 'model/gltf-binary'],
    ['/assets/main-3f2a.js', 'text/javascript; charset=utf-8'],
    ['/sw.js', 'text/javascript; charset=utf-8'],
    ['/manifest.webmanifest', 'application/manifest+json; charset=utf-8'],
  ])('%s is served as %s', async (path, type) => {
    const { origin } = await served();
    expect((await ask(origin, path)).headers['content-type']).toBe(type);
  });

  test('files named by their content are kept for ever, the others are asked for again', async () => {
    const { origin } = await served();
    const asset = await ask(origin, '/assets/main-3f2a.js');
    expect(asset.headers['cache-control']).toBe('public, max-age=31536000, immutable');
    for (const path of ['/', '/models/learned.onnx', '/avatars/mannequin.vrm', '/sw.js']) {
      expect((await ask(origin, path)).headers['cache-control']).toBe('no-cache');
    }
  });

  test('an unchanged file is not sent twice, a changed one is', async () => {
    const { origin } = await served();
    const etag = String((await ask(origin, '/models/learned.onnx')).headers.etag);
    const again = await ask(origin, '/models/learned.onnx', { headers: { 'if-none-match': etag } });
    expect(again.status).toBe(304);
    expect(again.body).toHaveLength(0);
    const other = await served({ ...site, 'models/learned.onnx': 'better weights' });
    const changed = await ask(other.origin, '/models/learned.onnx', { headers: { 'if-none-match': etag } });
    expect(changed.status).toBe(200);
    expect(changed.body.toString()).toBe('better weights');
  });

  test('a browser gets the smallest encoding it accepts, and only that', async () => {
    const { origin } = await served();
    const path = '/assets/runtime-77aa.wasm';
    const take = (accept: string) => ask(origin, path, { headers: { 'accept-encoding': accept } });
    const both = await take('gzip, deflate, br');
    expect(both.headers['content-encoding']).toBe('br');
    expect(both.headers['content-type']).toBe('application/wasm');
    expect(both.headers.vary).toBe('accept-encoding');
    expect(brotliDecompressSync(both.body)).toEqual(wasm);
    const gzip = await take('gzip, br;q=0');
    expect(gzip.headers['content-encoding']).toBe('gzip');
    expect(gunzipSync(gzip.body)).toEqual(wasm);
    const none = await take('identity');
    expect(none.headers['content-encoding']).toBeUndefined();
    expect(none.body).toEqual(wasm);
  });

  test('HEAD says what GET would send', async () => {
    const { origin } = await served();
    const head = await ask(origin, '/models/learned.onnx', { method: 'HEAD' });
    expect(head.status).toBe(200);
    expect(head.headers['content-length']).toBe('7');
    expect(head.body).toHaveLength(0);
  });

  test('a rebuild under the running server changes nothing that is being served', async () => {
    const { origin, directory } = await served();
    writeFileSync(join(directory, 'index.html'), 'half a');
    expect((await ask(origin, '/')).body.toString()).toBe(site['index.html']);
  });

  test('nothing to serve is said at start-up, naming the directory', () => {
    const empty = directoryWith();
    expect(() => createPageHandler(empty)).toThrow(`${empty} holds no index.html`);
  });
});

describe('what the page does not give', () => {
  test.each([
    '/../package.json',
    '/assets/../../package.json',
    '/%2e%2e/package.json',
    '/..%2fpackage.json',
    '/assets/..%5c..%5cpackage.json',
    '/.source-hash',
    '/index.html%00.js',
    '/constructor',
    '/assets/runtime-77aa.wasm.br',
    '/missing.html',
  ])('%s is not found', async (path) => {
    const { origin } = await served();
    const { status, headers } = await ask(origin, path);
    expect(status).toBe(404);
    expect(headers['content-type']).toBe('text/plain; charset=utf-8');
  });

  test('an address that is not well formed is a bad request, and the server goes on', async () => {
    const { origin } = await served();
    for (const path of ['/%E0%A4%A', '//', '///', '//etc/passwd', '//a:99999/', '/\\', 'http://[/', '*']) {
      expect((await ask(origin, path)).status, path).toBe(400);
    }
    expect((await ask(origin, '/')).status).toBe(200);
  });

  test('browsers get a page for a missing file, programs a line of text', async () => {
    const { origin } = await served({ ...site, '404.html': '<title>Not found</title>' });
    const people = await ask(origin, '/reslts', { headers: { accept: 'text/html,*/*' } });
    expect(people).toMatchObject({ status: 404, headers: { 'content-type': 'text/html; charset=utf-8' } });
    expect(people.body.toString()).toBe('<title>Not found</title>');
    for (const [path, accept] of [
      ['/reslts', '*/*'],
      ['/models/other.onnx', 'text/html'],
    ] as const) {
      const { status, body } = await ask(origin, path, { headers: { accept } });
      expect({ status, text: body.toString() }).toEqual({ status: 404, text: 'Not found.\n' });
    }
  });

  test('POST is refused and told what is allowed', async () => {
    const { origin } = await served();
    const { status, headers } = await ask(origin, '/', { method: 'POST' });
    expect(status).toBe(405);
    expect(headers.allow).toBe('GET, HEAD');
  });
});

test('every answer, errors included, says what the page may do', async () => {
  const { origin } = await served();
  for (const path of ['/', '/models/learned.onnx', '/missing', '/%E0%A4%A', '/healthz']) {
    const { headers } = await ask(origin, path);
    const policy = String(headers['content-security-policy']);
    expect(policy).toContain("script-src 'self' 'wasm-unsafe-eval'");
    expect(policy).not.toContain("'unsafe-eval'");
    expect(policy).toContain("worker-src 'self'");
    expect(headers['permissions-policy']).toContain('xr-spatial-tracking=(self)');
    expect(headers['x-content-type-options']).toBe('nosniff');
  }
});

/** A header of the page, another page, an asset and an error. */
async function headerOfEach(header: string, options: PageOptions): Promise<string[]> {
  const files = { 'index.html': 'page', 'results.html': 'results', 'assets/a.js': '1' };
  const { origin } = await served(files, options);
  const answers = await Promise.all(['/', '/results', '/assets/a.js', '/missing'].map((path) => ask(origin, path)));
  return answers.map(({ headers }) => String(headers[header]));
}

test('the page alone may read files of other servers, and only of those that are named', async () => {
  const connections = async (options: PageOptions) =>
    (await headerOfEach('content-security-policy', options)).map((policy) => /connect-src ([^;]*)/.exec(policy)?.[1]);
  const own = "'self' data: blob:";
  expect(await connections({})).toEqual([own, own, own, own]);
  const filesFrom = ['https://avatars.example', 'https://files.example:8443'];
  expect(await connections({ filesFrom })).toEqual([`${own} ${filesFrom.join(' ')}`, own, own, own]);
});

test('the microphone is for the page itself alone, and only where its people can talk', async () => {
  const policies = (microphone: boolean) => headerOfEach('permissions-policy', { microphone });
  const shut = 'xr-spatial-tracking=(self), camera=(), microphone=(), geolocation=()';
  expect(await policies(false)).toEqual([shut, shut, shut, shut]);
  expect(await policies(true)).toEqual([shut.replace('microphone=()', 'microphone=(self)'), shut, shut, shut]);
});

test('/healthz answers while the page is being served', async () => {
  const { origin } = await served();
  const { status, body } = await ask(origin, '/healthz');
  expect(status).toBe(200);
  expect(body.toString()).toBe('ok\n');
});
