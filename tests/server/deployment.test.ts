import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { relayConfigurationFrom } from 'threepoint-relay';
import { describe, expect, test } from 'vitest';
import { parse } from 'yaml';
import { configurationFrom } from '../../server/configuration';
import { installed } from './installed';

const deploy = (file: string) => fileURLToPath(new URL(`../../deploy/${file}`, import.meta.url));
const textOf = (file: string) => readFileSync(deploy(file), 'utf8');

interface Service {
  readonly build?: object;
  readonly image: string;
  readonly environment?: Readonly<Record<string, string>>;
  readonly volumes?: readonly string[];
  readonly ports?: readonly string[];
  readonly read_only?: boolean;
  readonly tmpfs?: readonly string[];
  readonly cap_drop?: readonly string[];
  readonly cap_add?: readonly string[];
  readonly security_opt?: readonly string[];
  readonly mem_limit?: string;
  readonly pids_limit?: number;
}

const compose = parse(textOf('compose.yaml'), { merge: true }) as {
  readonly services: Readonly<Record<string, Service>>;
};
const service = (name: string): Service => {
  const found = compose.services[name];
  if (!found) throw new Error(`compose.yaml: there is no service ${name}`);
  return found;
};
const dockerfile = textOf('Dockerfile');

/** Replaces `${NAME:-default}` and `${NAME:?message}` as compose does. */
function filled(text: string, given: Readonly<Record<string, string>>): string {
  return text.replace(/\$\{(\w+)(?::([-?])([^}]*))?\}/g, (_all, name: string, kind: string, rest: string) => {
    const value = given[name];
    if (value) return value;
    if (kind === '?') throw new Error(rest);
    return rest ?? '';
  });
}

const environmentOf = (name: string, given: Readonly<Record<string, string>>) =>
  Object.fromEntries(
    Object.entries(service(name).environment ?? {}).map(([key, value]) => [key, filled(String(value), given)]),
  );

const inImage = Object.fromEntries(
  [...dockerfile.matchAll(/^ENV (.*)$/gm)].flatMap(([, line]) =>
    (line ?? '').split(' ').map((pair) => pair.split('=') as [string, string]),
  ),
);

describe('compose.yaml', () => {
  const secret = { THREEPOINT_SECRET: 'kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gAzE4uV7iO' };

  test('gives every relay what it takes, and nothing that it does not know', () => {
    for (const name of ['relay-1', 'relay-2']) {
      const environment: Record<string, string> = { ...inImage, ...environmentOf(name, secret) };
      const read = new Set<string | symbol>();
      const observed = new Proxy(environment, {
        get(target, variable: string) {
          read.add(variable);
          return target[variable];
        },
      });
      expect(relayConfigurationFrom(observed)).toMatchObject({
        secret: secret.THREEPOINT_SECRET,
        redisUrl: 'redis://redis:6379',
        trustProxy: true,
        host: '0.0.0.0',
        logLevel: 'info',
      });
      expect(configurationFrom([], observed)).toMatchObject({ port: 3333, studyDirectory: '/studies' });
      expect([...read]).toEqual(expect.arrayContaining(Object.keys(environment)));
    }
  });

  test('does not start without a secret', () => {
    expect(() => environmentOf('relay-1', {})).toThrow('set THREEPOINT_SECRET');
    expect(() => relayConfigurationFrom(environmentOf('relay-1', { THREEPOINT_SECRET: 'short' }))).toThrow(
      'it needs 32',
    );
  });

  test('gives the proxy every address that its configuration asks for, at the ports where they listen', () => {
    const environment = service('proxy').environment ?? {};
    const asked = new Set([...textOf('haproxy.cfg').matchAll(/\$\{(\w+)\}/g)].map(([, name]) => name));
    expect(Object.keys(environment).sort()).toEqual([...asked].sort());
    for (const name of ['RELAY_1', 'RELAY_2']) {
      const [host, port] = (environment[name] ?? '').split(':');
      expect(compose.services).toHaveProperty(host ?? '');
      expect(port).toBe(inImage.PORT);
    }
    expect(service('proxy').ports).toEqual(['8080:8080']);
    expect(environment.PROXY_BIND).toBe(':8080');
  });
});

describe.each(Object.entries(compose.services))('the service %s', (name, found) => {
  test('has no privileges, a read-only file system, and bounds of memory and processes', () => {
    expect(found).toMatchObject({ read_only: true, cap_drop: ['ALL'], security_opt: ['no-new-privileges:true'] });
    expect(found.mem_limit).toMatch(/^\d+[mg]$/);
    expect(found.pids_limit).toBeGreaterThan(0);
    expect(found.tmpfs).toContain('/tmp');
    // The TURN server's program has the capability as an attribute of its file, and starts with it alone.
    expect(found.cap_add).toEqual(name === 'turn' ? ['NET_BIND_SERVICE'] : undefined);
  });
});

test('images are pinned by digest, and Dependabot moves the digests', () => {
  const images = [
    ...[...dockerfile.matchAll(/^FROM (\S+)/gm)].map(([, image]) => image ?? ''),
    ...Object.values(compose.services).flatMap(({ image, build }) => (build ? [] : image)),
  ];
  expect(images.length).toBeGreaterThan(3);
  for (const image of images) expect(image).toMatch(/^[\w/.-]+:[\w.-]+@sha256:[0-9a-f]{64}$/);
  const { updates } = parse(readFileSync(new URL('../../.github/dependabot.yml', import.meta.url), 'utf8')) as {
    readonly updates: readonly { readonly 'package-ecosystem': string; readonly directory: string }[];
  };
  for (const ecosystem of ['docker', 'docker-compose'])
    expect(updates).toContainEqual(expect.objectContaining({ 'package-ecosystem': ecosystem, directory: '/deploy' }));
});

test('the image keeps out the data of participants, and its user may write where studies go', () => {
  const ignored = textOf('Dockerfile.dockerignore').split('\n');
  for (const path of ['study-data', '.cache', 'node_modules', '.git']) expect(ignored).toContain(path);
  expect(dockerfile).toMatch(/chown node:node \/studies/);
  expect(dockerfile.indexOf('USER node')).toBeGreaterThan(dockerfile.indexOf('chown node:node'));
  expect(inImage.STUDIES).toBe('/studies');
  expect(service('relay-1').volumes).toContain('studies:/studies');
});

const haproxy = installed('haproxy');
// A program of the distribution, not ours to install: apt-get install haproxy
test.skipIf(!haproxy)(`the proxy takes its configuration${haproxy ? '' : ' (haproxy is not installed)'}`, () => {
  const environment = { PROXY_BIND: '127.0.0.1:8080', RELAY_1: '127.0.0.1:3333', RELAY_2: '127.0.0.1:3334' };
  const checked = spawnSync(haproxy ?? '', ['-c', '-f', deploy('haproxy.cfg')], {
    env: { ...process.env, ...environment },
    encoding: 'utf8',
  });
  expect(checked.stderr).not.toMatch(/ALERT|WARNING/);
  expect(checked.status).toBe(0);
});
