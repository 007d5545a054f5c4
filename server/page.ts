import { createHash } from 'node:crypto';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import type { IncomingMessage, ServerResponse } from 'node:http';
import { extname, join } from 'node:path';
import { securityHeaders } from './security-headers';

const contentTypes: Readonly<Record<string, string>> = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.mjs': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.json': 'application/json; charset=utf-8',
  '.map': 'application/json; charset=utf-8',
  '.txt': 'text/plain; charset=utf-8',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.jpg': 'image/jpeg',
  '.webp': 'image/webp',
  '.ico': 'image/x-icon',
  '.woff2': 'font/woff2',
  '.mp3': 'audio/mpeg',
  '.ogg': 'audio/ogg',
  '.wasm': 'application/wasm',
  '.onnx': 'application/octet-stream',
  '.vrm': 'model/gltf-binary',
  '.glb': 'model/gltf-binary',
  '.gltf': 'model/gltf+json',
};

/** Smallest first: the order in which a browser that takes several gets them. */
const encodings = [
  { name: 'br', suffix: '.br' },
  { name: 'gzip', suffix: '.gz' },
] as const;

interface Encoded {
  readonly body: Buffer;
  readonly headers: Readonly<Record<string, string | number>>;
}

interface ServedFile {
  readonly plain: Encoded;
  readonly compressed: ReadonlyMap<string, Encoded>;
}

function encoded(body: Buffer, headers: Record<string, string>, encoding?: string): Encoded {
  const etag = `"${createHash('sha256').update(body).digest('base64url').slice(0, 22)}"`;
  const encodingHeader = encoding ? { 'content-encoding': encoding } : {};
  return { body, headers: { ...headers, ...encodingHeader, etag, 'content-length': body.length } };
}

function filesBelow(directory: string, prefix = ''): string[] {
  return readdirSync(directory, { withFileTypes: true }).flatMap((entry) => {
    if (entry.name.startsWith('.')) return [];
    const path = `${prefix}/${entry.name}`;
    return entry.isDirectory() ? filesBelow(join(directory, entry.name), path) : [path];
  });
}

function load(directory: string): ReadonlyMap<string, ServedFile> {
  const paths = new Set(filesBelow(directory));
  const files = new Map<string, ServedFile>();
  for (const path of paths) {
    const encoding = encodings.find(({ suffix }) => path.endsWith(suffix));
    if (encoding && paths.has(path.slice(0, -encoding.suffix.length))) continue;
    const headers = {
      'content-type': contentTypes[extname(path).toLowerCase()] ?? 'application/octet-stream',
      // Vite names what is in assets/ by its content; everything else keeps its name when it changes.
      'cache-control': path.startsWith('/assets/') ? 'public, max-age=31536000, immutable' : 'no-cache',
      vary: 'accept-encoding',
    };
    const compressed = new Map<string, Encoded>();
    for (const { name, suffix } of encodings) {
      if (paths.has(path + suffix)) {
        compressed.set(name, encoded(readFileSync(join(directory, path + suffix)), headers, name));
      }
    }
    files.set(path, { plain: encoded(readFileSync(join(directory, path)), headers), compressed });
  }
  return files;
}

/** Whether an Accept-Encoding header takes this encoding: named, and not with q=0. */
function accepts(header: string | undefined, encoding: string): boolean {
  return (header ?? '').split(',').some((part) => {
    const [name, ...parameters] = part
      .trim()
      .toLowerCase()
      .split(/\s*;\s*/);
    return name === encoding && !parameters.some((parameter) => /^q=0(\.0*)?$/.test(parameter));
  });
}

function pathOf(url: string | undefined): string | null {
  try {
    const path = decodeURIComponent((url ?? '/').replace(/[?#].*$/s, ''));
    return path.endsWith('/') ? `${path}index.html` : path;
  } catch (error) {
    if (error instanceof URIError) return null;
    throw error;
  }
}

function answer(response: ServerResponse, status: number, text: string, headers: Record<string, string> = {}): void {
  response.writeHead(status, { 'content-type': 'text/plain; charset=utf-8', 'cache-control': 'no-store', ...headers });
  response.end(`${text}\n`);
}

/**
 * Serves a built page from memory: the files are read once, so that a request touches no disk, no path leads out of the
 * directory, and a rebuild under a running server breaks nobody's download. Throws where there is no index.html.
 */
export function createPageHandler(directory: string): (request: IncomingMessage, response: ServerResponse) => void {
  if (!existsSync(join(directory, 'index.html'))) {
    throw new Error(`${directory} holds no index.html: build the page first (npm run build)`);
  }
  const files = load(directory);
  return (request, response) => {
    for (const [name, value] of Object.entries(securityHeaders)) response.setHeader(name, value);
    if (request.method !== 'GET' && request.method !== 'HEAD') {
      answer(response, 405, 'Only GET and HEAD are answered here.', { allow: 'GET, HEAD' });
      return;
    }
    const path = pathOf(request.url);
    if (path === null) {
      answer(response, 400, 'This address is not well formed.');
      return;
    }
    if (path === '/healthz') {
      answer(response, 200, 'ok');
      return;
    }
    // Pages are asked for by their name alone: /results is results.html.
    const file = files.get(path) ?? files.get(`${path}.html`);
    if (!file) {
      answer(response, 404, 'Not found.');
      return;
    }
    const encoding = encodings.find(
      ({ name }) => file.compressed.has(name) && accepts(request.headers['accept-encoding'], name),
    );
    const { body, headers } = (encoding && file.compressed.get(encoding.name)) ?? file.plain;
    const known = request.headers['if-none-match']?.split(/\s*,\s*/).map((tag) => tag.replace(/^W\//, ''));
    if (known?.includes(String(headers.etag))) {
      const { 'content-length': _, ...rest } = headers;
      response.writeHead(304, rest);
      response.end();
      return;
    }
    response.writeHead(200, headers);
    response.end(request.method === 'HEAD' ? undefined : body);
  };
}
