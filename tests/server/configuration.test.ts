import { ConfigurationError } from 'threepoint-http';
import { describe, expect, test } from 'vitest';
import { configurationFrom } from '../../server/configuration';
import { startupMessage } from '../../server/startup-message';

const noStudies = { studyDirectory: null, experimenterToken: null };

describe('the configuration', () => {
  test('studies lie at the command line’s path, else the environment’s; no argument is the token', () => {
    const environment = { STUDIES: '/var/studies', EXPERIMENTER_TOKEN: 'kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA+' };
    expect(configurationFrom([], environment)).toMatchObject({
      studyDirectory: '/var/studies',
      experimenterToken: 'kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA+',
    });
    expect(configurationFrom(['--studies', 'here'], environment)).toMatchObject({ studyDirectory: 'here' });
  });

  test('with nothing said: this machine alone, port 3333', () => {
    expect(configurationFrom([], {})).toEqual({ port: 3333, lan: false, ...noStudies });
  });

  test('the command line goes before the environment', () => {
    expect(configurationFrom([], { PORT: '8080' })).toMatchObject({ port: 8080, lan: false });
    expect(configurationFrom(['--port', '9000', '--lan'], { PORT: '8080' })).toMatchObject({ port: 9000, lan: true });
    expect(configurationFrom(['--port=0'], {})).toMatchObject({ port: 0, lan: false });
  });

  test.each([
    [['--port', 'many'], {}, /--port must be a port number from 0 to 65535, not "many"/],
    [['--port', '70000'], {}, /not "70000"/],
    [[], { PORT: '-1' }, /environment variable PORT must be a port number.*"-1"/],
    [[], { EXPERIMENTER_TOKEN: 'a token with spaces in it, and long' }, /EXPERIMENTER_TOKEN must have at most 256/],
    [
      [],
      { EXPERIMENTER_TOKEN: 'our-laboratory-token' },
      /EXPERIMENTER_TOKEN has 20 characters; it needs 32. Generate one: openssl rand -base64 32/,
    ],
    [['--studies='], {}, /--studies needs/],
    [['--lam'], {}, /--lam[\s\S]*Usage: npm start/],
    [['--port'], {}, /--port[\s\S]*Usage/],
    [['lan'], {}, /lan[\s\S]*Usage/],
  ])('%j with %j is refused in a sentence', (args, environment, message) => {
    expect(() => configurationFrom(args, environment)).toThrow(message);
    expect(() => configurationFrom(args, environment)).toThrow(ConfigurationError);
  });

  test('--help asks for help, beside any other option', () => {
    expect(configurationFrom(['--lan', '--help'], {})).toBe('help');
  });
});

describe('the welcome', () => {
  test('on this machine: the address, the cable and the network', () => {
    const text = startupMessage({ port: 3333, requestedPort: 3333, addresses: null });
    expect(text).toContain('http://localhost:3333');
    expect(text).toContain('adb reverse tcp:3333 tcp:3333');
    expect(text).toContain('npm start -- --lan');
    expect(text).not.toContain('taken');
  });

  test('on the network: every address, and the warning that will come', () => {
    const text = startupMessage({ port: 3334, requestedPort: 3333, addresses: ['192.168.7.20', '10.1.2.3'] });
    expect(text).toContain('Port 3333 is taken; using 3334.');
    expect(text).toContain('https://192.168.7.20:3334');
    expect(text).toContain('https://10.1.2.3:3334');
    expect(text).toContain('warns once');
  });

  test('without a network it says so', () => {
    expect(startupMessage({ port: 3333, requestedPort: 3333, addresses: [] })).toContain('on no network');
  });
});
