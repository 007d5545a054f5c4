import { describe, expect, test, vi } from 'vitest';
import { requestVrSession } from '../../../src/threepoint/xr/request-session';
import { describeXrSupport } from '../../../src/threepoint/xr/session-support';
import { reportFigures } from '../../reliability/report-figures';

/** A browser with this much of WebXR. */
function browser({ secure = true, xr }: { secure?: boolean; xr?: Partial<XRSystem> }) {
  vi.stubGlobal('window', { isSecureContext: secure });
  vi.stubGlobal('navigator', { xr });
}
const failing = (name: string) => (): Promise<never> => Promise.reject(new DOMException('the browser says no', name));

describe('why there is no VR', () => {
  test.each([
    ['no HTTPS', { secure: false }, /secure page: open it by https/],
    ['no WebXR', {}, /This browser has no WebXR/],
    ['no headset', { xr: { isSessionSupported: () => Promise.resolve(false) } }, /No headset is connected/],
    ['a policy', { xr: { isSessionSupported: failing('SecurityError') } }, /WebXR is not allowed here/],
  ] as const)('%s: a sentence', async (_, there, sentence) => {
    browser(there as Parameters<typeof browser>[0]);
    const support = await describeXrSupport();
    expect(support.kind).toBe('none');
    expect(support.sentence).toMatch(sentence);
    expect(support.sentence).toMatch(/\.$/);
  });

  test('with a headset there is nothing to say', async () => {
    browser({ xr: { isSessionSupported: () => Promise.resolve(true) } });
    expect(await describeXrSupport()).toEqual({ kind: 'device', sentence: null, passthrough: true });
    reportFigures('no-headset', { sentences: 'no HTTPS, no WebXR, no headset, policy, refused, no floor' });
  });

  test.each([
    ['NotAllowedError', 'the headset refused the session'],
    ['SecurityError', 'the headset refused the session'],
    ['NotSupportedError', 'the headset provides no floor-level reference space'],
    ['AbortError', 'the browser says no'],
  ])('a session refused with %s is a sentence', async (name, sentence) => {
    browser({ xr: { requestSession: failing(name) as unknown as XRSystem['requestSession'] } });
    await expect(requestVrSession()).rejects.toThrow(sentence);
  });
});
