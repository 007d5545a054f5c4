import { describe, expect, it } from 'vitest';
import { hideLabel, muteLabel, otherPlayers, type SeatRow } from '../../../src/page/people/panel/other-players';

const seated = (seat: number, change: Partial<SeatRow> = {}): SeatRow => ({
  ...{ seat, name: `Player ${seat}`, station: seat, label: `${seat + 1} · Player ${seat}`, role: 'Right thrower' },
  voice: 'open',
  link: 'connected',
  silenced: false,
  hidden: false,
  ...change,
});

/** Returns the entry of the only other player; `inVoices`: the page plays voices. */
const listed = (change: Partial<SeatRow>, inVoices = true) =>
  otherPlayers({ seat: 0, people: [seated(0), seated(1, change)] }, inVoices)[0];

describe('the other players', () => {
  it('are those on the seats but for oneself; to a spectator all of them', () => {
    const people = [seated(0), seated(1, { name: null }), seated(2, { name: 'free' })];
    const names = (seat: number | null) => otherPlayers({ seat, people }, true).map(({ name }) => name);
    expect(names(0)).toEqual(['free']);
    expect(names(null)).toEqual(['Player 0', 'free']);
  });

  it('have a status: audible, muted by themselves, muted or hidden by the user, not connected', () => {
    expect(listed({})?.status).toBe('can be heard');
    expect(listed({ voice: 'muted' })?.status).toBe('muted');
    expect(listed({ silenced: true })?.status).toBe('muted by you');
    expect(listed({ silenced: true, hidden: true })?.status).toBe('hidden');
    expect(listed({ link: 'connecting' })?.status).toBe('connecting …');
    expect(listed({ link: 'lost' })?.status).toBe('connection lost');
    expect(listed({ voice: 'none', link: 'none' })?.status).toBe('');
  });

  it('can be muted where they have a voice here, and not while they are hidden', () => {
    expect(listed({})?.muting).toBe('offered');
    expect(listed({ silenced: true })?.muting).toBe('offered');
    expect(listed({ hidden: true })?.muting).toBe('off');
    expect(listed({ voice: 'none' })?.muting).toBe('none');
  });

  it('can be hidden, and nothing else, by a user who hears no one', () => {
    expect(listed({}, false)).toMatchObject({ status: '', muting: 'none', hidden: false });
    expect(listed({ hidden: true }, false)).toMatchObject({ status: 'hidden', muting: 'none', hidden: true });
  });

  it('have buttons that say what a press does', () => {
    expect([muteLabel({ silenced: false }), muteLabel({ silenced: true })]).toEqual(['Mute', 'Unmute']);
    expect([hideLabel({ hidden: false }), hideLabel({ hidden: true })]).toEqual(['Hide', 'Show']);
  });
});
