import { PersonMarks } from 'threepoint-page/ball/person-marks';
import { describe, expect, it } from 'vitest';

const person = (name: string) => ({ name, bot: false });
const bot = (name: string) => ({ name, bot: true });

/** A room of three with Ann, Ben and no one. */
function room() {
  const marks = new PersonMarks();
  marks.follow([person('Ann'), person('Ben'), null]);
  return marks;
}

describe('a person who is muted or hidden', () => {
  it('stays so until the user takes it back', () => {
    const marks = room();
    marks.set('silenced', 1, true);
    marks.set('hidden', 0, true);
    marks.follow([person('Ann'), person('Ben'), person('Cal')]);
    expect([0, 1, 2].map((seat) => marks.has('silenced', seat))).toEqual([false, true, false]);
    expect([...marks.hidden]).toEqual([0]);
    expect([0, 1, 2].map((seat) => marks.mutes(seat))).toEqual([true, true, false]);
    marks.set('silenced', 1, false);
    marks.set('hidden', 0, false);
    expect([0, 1].map((seat) => marks.mutes(seat))).toEqual([false, false]);
  });

  it('stays so on another seat, and after a time among the spectators', () => {
    const marks = room();
    marks.set('silenced', 1, true);
    marks.set('hidden', 1, true);
    marks.follow([person('Ann'), null, null]);
    expect(marks.mutes(1)).toBe(false);
    marks.follow([person('Ann'), null, person('Ben')]);
    expect([marks.has('silenced', 2), marks.has('hidden', 2)]).toEqual([true, true]);
    marks.follow([person('Ann'), person('Ben'), null]);
    expect([marks.has('silenced', 1), marks.has('hidden', 2)]).toEqual([true, false]);
  });

  it('changes seats with another in one message, each with what is theirs', () => {
    const marks = room();
    marks.set('silenced', 0, true);
    marks.set('hidden', 1, true);
    marks.follow([person('Ben'), person('Ann'), null]);
    expect([marks.has('silenced', 1), marks.has('hidden', 0)]).toEqual([true, true]);
    expect([marks.has('silenced', 0), marks.has('hidden', 1)]).toEqual([false, false]);
  });

  it('leaves nothing to the next person on the seat', () => {
    const marks = room();
    marks.set('hidden', 1, true);
    marks.follow([person('Ann'), person('Eve'), null]);
    expect(marks.mutes(1)).toBe(false);
  });

  it('is another one than a person of the same name beside them', () => {
    const marks = new PersonMarks();
    marks.follow([person('Ben'), person('Ben'), null]);
    marks.set('silenced', 1, true);
    expect(marks.mutes(0)).toBe(false);
    marks.follow([person('Ben'), null, person('Ben')]);
    expect([0, 1, 2].map((seat) => marks.mutes(seat))).toEqual([false, false, true]);
  });
});

it('a bot that was hidden leaves nothing to who has its name later, on its seat or another', () => {
  const marks = new PersonMarks();
  marks.follow([person('Ann'), bot('Max'), null]);
  marks.set('hidden', 1, true);
  marks.follow([person('Ann'), null, null]);
  marks.follow([person('Ann'), bot('Max'), person('Max')]);
  expect([...marks.hidden]).toEqual([]);
  marks.set('hidden', 1, true);
  marks.follow([person('Ann'), person('Max'), null]);
  expect([...marks.hidden]).toEqual([]);
});
