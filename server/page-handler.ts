import { createHash } from 'node:crypto';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import type { IncomingHttpHeaders, IncomingMessage, RequestListener } from 'node:http';
import { extname, join } from 'node:path';
import {
  contentSecurityPolicy,
  type HttpResponse,
  parseRequestTarget,
  permissionsPolicy,
  sendResponse,
  textResponse,
} from 'threepoint-http';

const contentTypes: Readonly<Record<string, string>> = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.mjs': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.json': 'application/json; charset=utf-8',
  '.map': 'application/json; charset=utf-8',
  '.txt': 'text/plain; charset=utf-8',
  '.webmanifest': 'application/manifest+json; charset=utf-8',
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

/** The encodings, smallest first: a browser that accepts several gets the first. */
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
  return { body, headers: { ...headers, ...encodingHeader, etag } };
}

function filesBelow(directory: string, prefix = ''): string[] {
  return readdirSync(directory, { withFileTypes: true }).flatMap((entry) => {
    if (entry.name.startsWith('.')) return [];
    const path = `${prefix}/${entry.name}`;
    return entry.isDirectory() ? filesBelow(join(directory, entry.name), path) : [path];
  });
}

export interface PageOptions {
  /** Whether the page may use the microphone. Default: false. */
  readonly microphone?: boolean;
  /** Origins of other servers from which the page may read files that are named by address. */
  readonly filesFrom?: readonly string[];
}

function load(directory: string, { microphone = false, filesFrom = [] }: PageOptions): ReadonlyMap<string, ServedFile> {
  const paths = new Set(filesBelow(directory));
  const files = new Map<string, ServedFile>();
  for (const path of paths) {
    const encoding = encodings.find(({ suffix }) => path.endsWith(suffix));
    if (encoding && paths.has(path.slice(0, -encoding.suffix.length))) continue;
    const headers = {
      'content-type': contentTypes[extname(path).toLowerCase()] ?? 'application/octet-stream',
      // Vite puts a content hash into the names in assets/; other files keep their names when they change.
      'cache-control': path.startsWith('/assets/') ? 'public, max-age=31536000, immutable' : 'no-cache',
      vary: 'accept-encoding',
      // Only this page has voices and opens files by address.
      ...(path === '/index.html' && {
        'permissions-policy': permissionsPolicy(microphone),
        'content-security-policy': contentSecurityPolicy(filesFrom),
      }),
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

/** Returns whether an Accept-Encoding header accepts this encoding: it is named, and not with q=0. */
function accepts(header: string | undefined, encoding: string): boolean {
  return (header ?? '').split(',').some((part) => {
    const [name, ...parameters] = part
      .trim()
      .toLowerCase()
      .split(/\s*;\s*/);
    return name === encoding && !parameters.some((parameter) => /^q=0(\.0*)?$/.test(parameter));
  });
}

/**
 * Creates a handler that serves a built page from memory. Files are read once: a request touches no disk, no path leads
 * out of the directory, and a rebuild breaks no download. Throws if there is no index.html.
 */
export function createPageHandler(directory: string, options: PageOptions = {}): RequestListener {
  if (!existsSync(join(directory, 'index.html'))) {
    throw new Error(`${directory} holds no index.html. Build the page first: npm run build`);
  }
  const files = load(directory, options);

  function respondWith({ plain, compressed }: ServedFile, asked: IncomingHttpHeaders, status = 200): HttpResponse {
    const encoding = encodings.find(({ name }) => compressed.has(name) && accepts(asked['accept-encoding'], name));
    const { body, headers } = (encoding && compressed.get(encoding.name)) ?? plain;
    const known = asked['if-none-match']?.split(/\s*,\s*/).map((tag) => tag.replace(/^W\//, ''));
    return known?.includes(String(headers.etag)) ? { status: 304, headers } : { status, headers, body };
  }

  function answerTo({ method, url, headers: asked }: IncomingMessage): HttpResponse {
    if (method !== 'GET' && method !== 'HEAD') {
      const rejected = textResponse('Only GET and HEAD are answered here.', 405);
      return { ...rejected, headers: { ...rejected.headers, allow: 'GET, HEAD' } };
    }
    const target = parseRequestTarget(url);
    if (!target) return textResponse('This address is not well formed.', 400);
    const { decodedPath: path } = target;
    if (path === '/healthz') return textResponse('ok');
    const name = path.endsWith('/') ? `${path}index.html` : path;
    // Pages are requested by name: /results is results.html.
    const file = files.get(name) ?? files.get(`${name}.html`);
    if (file) return respondWith(file, asked);
    // The links of the page for people are relative to the root.
    const page = /^\/[^/]*$/.test(path) && asked.accept?.includes('text/html') ? files.get('/404.html') : undefined;
    return page ? respondWith(page, {}, 404) : textResponse('Not found.', 404);
  }

  return (request, response) => sendResponse(request, response, answerTo(request));
}
