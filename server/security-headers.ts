/**
 * What the page may do. Scripts are ours alone and nothing evaluates text; WebAssembly may compile.
 * Styles: the emulator's panels set style attributes. Pictures and connections: textures inside a VRM become blob: URLs, and
 * a person may name an avatar on another server (https:); the page itself asks for nothing beyond its own origin.
 */
export const contentSecurityPolicy = [
  "default-src 'self'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "worker-src 'self'",
  "style-src 'self' 'unsafe-inline'",
  "img-src 'self' data: blob:",
  "connect-src 'self' data: blob: https:",
  "object-src 'none'",
  "base-uri 'none'",
  "form-action 'self'",
  "frame-ancestors 'self'",
].join('; ');

/** What the browser lets a page use of the device. */
export const permissionsPolicy = (microphone: boolean): string =>
  `xr-spatial-tracking=(self), camera=(), microphone=(${microphone ? 'self' : ''}), geolocation=()`;

/** On every answer, errors included. */
export const securityHeaders: Readonly<Record<string, string>> = {
  'content-security-policy': contentSecurityPolicy,
  'permissions-policy': permissionsPolicy(false),
  'x-content-type-options': 'nosniff',
  'referrer-policy': 'no-referrer',
  'cross-origin-resource-policy': 'same-origin',
};
