import type { IncomingMessage } from 'node:http';
import { hostname } from 'node:os';
import { describe, expect, test } from 'vitest';
import { createSitePolicy, type SitePolicyOptions } from '../../src/http/site-policy';

const request = (headers: Record<string, string>, encrypted = false) =>
  ({ headers, socket: encrypted ? { encrypted: true } : {} }) as unknown as IncomingMessage;

const policy = (options: Partial<SitePolicyOptions> = {}) =>
  createSitePolicy({ origins: [], hosts: [], trustProxy: false, ...options });

describe('the name that a request asks for', () => {
  test.each([
    'localhost:3333',
    'LOCALHOST',
    'localhost.:3333',
    'page.localhost:3333',
    '127.0.0.1:5173',
    '[::1]:3333',
    '192.168.7.20:3333',
    hostname(),
    `${hostname().toLowerCase()}.local:3333`,
  ])('%s is one of this machine', (host) => {
    expect(policy().checkHost(request({ host }))).toBeNull();
  });

  test.each(['evil.example:3333', 'localhost.evil.example', '127.0.0.1.evil.example', 'xn--localhost-.example'])(
    '%s is none: a name that another site pointed here',
    (host) => {
      expect(policy().checkHost(request({ host }))).toMatchObject({ status: 421 });
    },
  );

  test.each(['', 'a b', 'a/b', 'a@b', 'localhost:port', '::::'])('"%s" is no name at all', (host) => {
    expect(policy().checkHost(request({ host }))).toMatchObject({ status: 400 });
  });

  test('may be one that the server was told, by itself or as an origin', () => {
    const told = policy({ hosts: ['Study.Example'], origins: ['https://play.example'] });
    expect(told.checkHost(request({ host: 'study.example:8080' }))).toBeNull();
    expect(told.checkHost(request({ host: 'play.example' }))).toBeNull();
    expect(told.checkHost(request({ host: 'other.example' }))).toMatchObject({ status: 421 });
  });
});

describe('the page behind a request', () => {
  const from = (origin: string, host = 'localhost:3333', more: Record<string, string> = {}) =>
    request({ host, origin, ...more });

  test('is ours where it has the very origin of the server: scheme, name and port', () => {
    expect(policy().checkOrigin(from('http://localhost:3333'))).toBeNull();
    expect(policy().checkOrigin(request({ host: 'a.example', origin: 'https://a.example' }, true))).toBeNull();
    for (const origin of [
      'https://localhost:3333',
      'http://localhost:3334',
      'http://127.0.0.1:3333',
      'http://evil.example',
      'http://localhost:3333.evil.example',
      'null',
      '',
    ]) {
      expect(policy().checkOrigin(from(origin)), origin).toMatchObject({ status: 403 });
    }
  });

  test('is requested under development through the server of the sources, on its own port', () => {
    expect(policy().checkOrigin(from('http://localhost:5173', 'localhost:5173'))).toBeNull();
  });

  test('has the origin that a TLS proxy or the server’s configuration gives', () => {
    const told = { 'x-forwarded-proto': 'https' };
    expect(policy({ trustProxy: true }).checkOrigin(from('https://a.example', 'a.example', told))).toBeNull();
    expect(policy().checkOrigin(from('https://a.example', 'a.example', told))).toMatchObject({ status: 403 });
    const configured = policy({ origins: ['https://a.example'] });
    expect(configured.checkOrigin(from('https://a.example', 'inside:3333'))).toBeNull();
    expect(configured.checkOrigin(from('http://inside:3333', 'inside:3333'))).toMatchObject({ status: 403 });
  });

  test('is not needed by programs; a browser that hides it says where the request came from', () => {
    expect(policy().checkOrigin(request({ host: 'localhost' }))).toBeNull();
    for (const site of ['cross-site', 'same-site']) {
      expect(policy().checkOrigin(request({ host: 'localhost', 'sec-fetch-site': site }))).not.toBeNull();
    }
    expect(policy().checkOrigin(request({ host: 'localhost', 'sec-fetch-site': 'same-origin' }))).toBeNull();
  });
});
