import { describe, expect, test } from 'vitest';
import { GroupCommit } from '../../src/http/group-commit';
import { consentAt } from '../study/model/studies';
import { now, servedPaperStudy } from '../study/server/running-studies';

/** A disk whose flushes end when the test says so. */
function heldDisk() {
  const under: { readonly end: () => void; readonly fail: (error: Error) => void }[] = [];
  let started = 0;
  let told: () => void = () => undefined;
  return {
    /** How many flushes have begun. */
    get started() {
      return started;
    },
    flush: () =>
      new Promise<void>((end, fail) => {
        under.push({ end, fail });
        started += 1;
        told();
      }),
    /** Resolves when so many have begun. */
    async begun(count: number): Promise<void> {
      while (started < count) await new Promise<void>((resolve) => (told = resolve));
    },
    end: () => under.shift()?.end(),
    fail: () => under.shift()?.fail(new Error('the disk failed')),
  };
}

const order = (log: string[], name: string, flushed: Promise<void>) => flushed.then(() => void log.push(name));

describe('flushes for many at once', () => {
  test('a caller during a flush waits for the next one, which all such callers share', async () => {
    const disk = heldDisk();
    const shared = new GroupCommit(disk.flush);
    const log: string[] = [];
    const first = order(log, 'first', shared.flush());
    await disk.begun(1);
    const later = ['second', 'third', 'fourth'].map((name) => order(log, name, shared.flush()));
    disk.end();
    await first;
    await disk.begun(2);
    expect(log).toEqual(['first']);
    disk.end();
    await Promise.all(later);
    expect(log).toEqual(['first', 'second', 'third', 'fourth']);
    expect(disk.started).toBe(2);
  });

  test('a caller while no flush is under way waits for its own', async () => {
    const disk = heldDisk();
    const shared = new GroupCommit(disk.flush);
    for (let count = 1; count <= 3; count++) {
      const flushed = shared.flush();
      await disk.begun(count);
      disk.end();
      await flushed;
    }
  });

  test('after one has failed nothing is said to be on the disk any more', async () => {
    const disk = heldDisk();
    const shared = new GroupCommit(disk.flush);
    const first = shared.flush();
    await disk.begun(1);
    const second = shared.flush();
    disk.fail();
    await expect(first).rejects.toThrow('the disk failed');
    await expect(second).rejects.toThrow('the disk failed');
    await expect(shared.flush()).rejects.toThrow('the disk failed');
    expect(disk.started).toBe(1);
  });
});

describe('the server of studies', () => {
  const own = '/api/studies/paper/participants/P01';

  test('acknowledges only what is on the disk, and answers who reads meanwhile', async () => {
    const disk = heldDisk();
    const { ask, invited, store } = await servedPaperStudy({}, { flush: disk.flush });
    const log: string[] = [];
    const claimed = ask('POST', `${own}/claim`, { json: invited('P01') });
    await disk.begun(1);
    disk.end();
    const { token } = (await claimed).json;
    const consent = consentAt(now);
    const sent = ask('POST', `${own}/records`, { token, json: { records: [consent] } }).then(({ status }) => {
      log.push(`acknowledged ${status}`);
    });
    await disk.begun(2);
    expect((await ask('GET', `${own}/records`, { token })).json.records).toHaveLength(1);
    // Sent again, it is there already, and still not on the disk.
    const again = ask('POST', `${own}/records`, { token, json: { records: [consent] } }).then(({ status }) => {
      log.push(`acknowledged again ${status}`);
    });
    expect((await ask('GET', `${own}/commands?after=0`, { token })).status).toBe(200);
    expect(log).toEqual([]);
    disk.end();
    await sent;
    await disk.begun(3);
    disk.end();
    await again;
    expect(log).toEqual(['acknowledged 200', 'acknowledged again 200']);
    expect(store.records.all('paper', 'P01')).toHaveLength(1);
  });
});
