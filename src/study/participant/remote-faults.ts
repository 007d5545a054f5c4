import { setupFaults } from '../model/plan/remote-setup';
import type { ParticipantSession } from './session/participant-session';
import type { StudyHost } from './trial/study-host';

/**
 * Returns what prevents a participant who takes part alone from beginning on this device; `eyeHeight` [m], null: not
 * measured yet.
 */
export function remoteFaults(
  { plan: { remote }, phrases }: Pick<ParticipantSession, 'plan' | 'phrases'>,
  host: Pick<StudyHost, 'inSession' | 'deviceFault' | 'room'>,
  eyeHeight: number | null,
): readonly string[] {
  if (!remote) return [];
  const deviceFault = host.inSession() ? null : host.deviceFault();
  return setupFaults(remote, { deviceFault, room: host.room(), eyeHeight }, phrases);
}
