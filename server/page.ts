import { createHash } from 'node:crypto';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import type { IncomingMessage, RequestListener } from 'node:http';
import { extname, join } from 'node:path';
import { type Answer, plain, sendAnswer } from 'threepoint-http/answer';
import { contentSecurityPolicy, permissionsPolicy } from 'threepoint-http/security-headers';
import { targetOf } from 'threepoint-http/target';

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
  /** The page may use the microphone. */
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
      // Vite names what is in assets/ by its content; everything else keeps its name when it changes.
      'cache-control': path.startsWith('/assets/') ? 'public, max-age=31536000, immutable' : 'no-cache',
      vary: 'accept-encoding',
      // The page where people talk to each other and open files by address, and no other file.
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

/**
 * Serves a built page from memory: the files are read once, so that a request touches no disk, no path leads out of the
 * directory, and a rebuild under a running server breaks no download. Throws where there is no index.html.
 */
export function createPageHandler(directory: string, options: PageOptions = {}): RequestListener {
  if (!existsSync(join(directory, 'index.html'))) {
    throw new Error(`${directory} holds no index.html: build the page first (npm run build)`);
  }
  const files = load(directory, options);

  function answerTo({ method, url, headers: asked }: IncomingMessage): Answer {
    if (method !== 'GET' && method !== 'HEAD') {
      const refused = plain('Only GET and HEAD are answered here.', 405);
      return { ...refused, headers: { ...refused.headers, allow: 'GET, HEAD' } };
    }
    const target = targetOf(url);
    if (!target) return plain('This address is not well formed.', 400);
    const path = decodeURIComponent(target.path);
    if (path === '/healthz') return plain('ok');
    const name = path.endsWith('/') ? `${path}index.html` : path;
    // Pages are asked for by their name alone: /results is results.html.
    const file = files.get(name) ?? files.get(`${name}.html`);
    if (!file) return plain('Not found.', 404);
    const encoding = encodings.find(
      ({ name: encodingName }) => file.compressed.has(encodingName) && accepts(asked['accept-encoding'], encodingName),
    );
    const { body, headers } = (encoding && file.compressed.get(encoding.name)) ?? file.plain;
    const known = asked['if-none-match']?.split(/\s*,\s*/).map((tag) => tag.replace(/^W\//, ''));
    return known?.includes(String(headers.etag)) ? { status: 304, headers } : { status: 200, headers, body };
  }

  return (request, response) => sendAnswer(request, response, answerTo(request));
}
