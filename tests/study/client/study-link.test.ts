import { expect, test } from 'vitest';
import { invitationIn, studyLink } from '../../../src/study/client/study-link';

test('a link gives the server study and participant, and keeps the invitation for the page', () => {
  const link = new URL(
    studyLink({ study: 'paper', participant: 'P07', invitation: 'G4F9-TMTZ-4S8W-GZ1P' }),
    'https://a.example/threepoint/',
  );
  expect(link.pathname).toBe('/threepoint/');
  expect(link.search).toBe('?study=paper&participant=P07');
  expect(link.search).not.toContain('G4F9');
  expect(invitationIn(link.hash)).toBe('G4F9-TMTZ-4S8W-GZ1P');
});

test('an address without an invitation has none, even if something else stands behind "#"', () => {
  expect(studyLink({ study: 'paper', participant: null, invitation: null })).toBe('./?study=paper');
  for (const hash of ['', '#', '#top', '#invitation', '#invitation=']) expect(invitationIn(hash), hash).toBeNull();
});
