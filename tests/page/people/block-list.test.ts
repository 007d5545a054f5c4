import { describe, expect, it } from 'vitest';
import { BlockList } from '../../../src/page/people/voices/block-list';

const person = (name: string) => ({ name, bot: false });
const bot = (name: string) => ({ name, bot: true });

/** A room of three with Ann, Ben and no one. */
function room() {
  const blocked = new BlockList();
  blocked.update([person('Ann'), person('Ben'), null]);
  return blocked;
}

describe('a person who is muted or hidden', () => {
  it('stays so until the user takes it back', () => {
    const blocked = room();
    blocked.set('silenced', 1, true);
    blocked.set('hidden', 0, true);
    blocked.update([person('Ann'), person('Ben'), person('Cal')]);
    expect([0, 1, 2].map((seat) => blocked.has('silenced', seat))).toEqual([false, true, false]);
    expect([...blocked.hidden]).toEqual([0]);
    expect([0, 1, 2].map((seat) => blocked.mutes(seat))).toEqual([true, true, false]);
    blocked.set('silenced', 1, false);
    blocked.set('hidden', 0, false);
    expect([0, 1].map((seat) => blocked.mutes(seat))).toEqual([false, false]);
  });

  it('stays so on another seat, and after a time among the spectators', () => {
    const blocked = room();
    blocked.set('silenced', 1, true);
    blocked.set('hidden', 1, true);
    blocked.update([person('Ann'), null, null]);
    expect(blocked.mutes(1)).toBe(false);
    blocked.update([person('Ann'), null, person('Ben')]);
    expect([blocked.has('silenced', 2), blocked.has('hidden', 2)]).toEqual([true, true]);
    blocked.update([person('Ann'), person('Ben'), null]);
    expect([blocked.has('silenced', 1), blocked.has('hidden', 2)]).toEqual([true, false]);
  });

  it('changes seats with another in one message, each with what is theirs', () => {
    const blocked = room();
    blocked.set('silenced', 0, true);
    blocked.set('hidden', 1, true);
    blocked.update([person('Ben'), person('Ann'), null]);
    expect([blocked.has('silenced', 1), blocked.has('hidden', 0)]).toEqual([true, true]);
    expect([blocked.has('silenced', 0), blocked.has('hidden', 1)]).toEqual([false, false]);
  });

  it('leaves nothing to the next person on the seat', () => {
    const blocked = room();
    blocked.set('hidden', 1, true);
    blocked.update([person('Ann'), person('Eve'), null]);
    expect(blocked.mutes(1)).toBe(false);
  });

  it('is another one than a person of the same name beside them', () => {
    const blocked = new BlockList();
    blocked.update([person('Ben'), person('Ben'), null]);
    blocked.set('silenced', 1, true);
    expect(blocked.mutes(0)).toBe(false);
    blocked.update([person('Ben'), null, person('Ben')]);
    expect([0, 1, 2].map((seat) => blocked.mutes(seat))).toEqual([false, false, true]);
  });
});

it('a hidden bot leaves nothing to later bearers of its name, on its seat or another', () => {
  const blocked = new BlockList();
  blocked.update([person('Ann'), bot('Max'), null]);
  blocked.set('hidden', 1, true);
  blocked.update([person('Ann'), null, null]);
  blocked.update([person('Ann'), bot('Max'), person('Max')]);
  expect([...blocked.hidden]).toEqual([]);
  blocked.set('hidden', 1, true);
  blocked.update([person('Ann'), person('Max'), null]);
  expect([...blocked.hidden]).toEqual([]);
});

it('lists the bodies of all players who are not hidden, muted ones included', () => {
  const blocked = room();
  blocked.set('silenced', 0, true);
  blocked.set('hidden', 1, true);
  const bodies = [{ id: 0 }, { id: 1 }, { id: 2 }];
  expect(blocked.visible(bodies)).toEqual([{ id: 0 }, { id: 2 }]);
});

it('notifies after a change of a block, and when a block moves to another seat', () => {
  let changes = 0;
  const blocked = new BlockList(() => {
    changes += 1;
  });
  const seats = [person('Ann'), person('Ben'), null];
  blocked.update(seats);
  const before = changes;
  blocked.set('silenced', 1, true);
  blocked.update(seats);
  expect(changes).toBe(before + 1);
  blocked.update([null, person('Ann'), person('Ben')]);
  expect([changes, blocked.mutes(2)]).toEqual([before + 2, true]);
});
