import './experimenter-access.css';
import { signal, useSignal } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { reasonOf } from 'threepoint/core';
import { pageFolder, ServerPresence, type ServerState } from 'threepoint-ui';
import { Button, Chooser, type ChooserProps, Complaint, Labelled } from 'threepoint-ui/controls';
import { createExperimenterClient, type ExperimenterClient, noStudiesHere } from '../client/study-client';
import type { RecordedStudy, StudyListing } from '../model/progress/study-api';

/**
 * The key under which the session storage keeps the token while the tab is open. It is not kept longer, because
 * computers are shared.
 */
const tokenKey = 'threepoint-experimenter-token';

const presence = new ServerPresence(pageFolder(), () => undefined);
/** Whether the page's host has no studies. */
const withoutServer = signal(false);

/** The client of the user who has entered the experimenter's token; null: no token was accepted yet. */
export const client = signal<ExperimenterClient | null>(null);

/** The studies of the server as they were last requested. */
const listed = signal<readonly StudyListing[]>([]);

export async function listStudies(from: ExperimenterClient): Promise<void> {
  listed.value = await from.studies();
}

/**
 * Signs in with the token of this tab, if there is one. `open` is called with the study in the address after that, and
 * with the version of its plan if the address has one.
 */
export function resume(open: (study: string, version?: number) => void): void {
  client.subscribe((signedIn) => {
    const { study, version } = Object.fromEntries(new URLSearchParams(location.search));
    if (signedIn && study) open(study, version === undefined ? undefined : Number(version));
  });
  void noteServer(presence.whenKnown());
  const token = sessionStorage.getItem(tokenKey);
  if (token !== null) void signIn(token);
}

async function noteServer(state: Promise<ServerState>): Promise<void> {
  withoutServer.value = (await state) === 'none';
}

/** Resolves with a complaint, or with null if the token is accepted. */
async function signIn(token: string): Promise<string | null> {
  const candidate = createExperimenterClient(token, pageFolder());
  try {
    await listStudies(candidate);
  } catch (error) {
    return reasonOf(error);
  }
  sessionStorage.setItem(tokenKey, token);
  client.value = candidate;
  return null;
}

/**
 * Resolves with plan and records of a study under this version of its plan or the newest one, and puts the study into
 * the address.
 */
export async function requestStudy(from: ExperimenterClient, id: string, version?: number): Promise<RecordedStudy> {
  const recorded = await from.records(id, version);
  putIntoAddress(id, version);
  return recorded;
}

/** Puts the open study into the address, so that a reload opens it again; null: none is open. */
export function putIntoAddress(study: string | null, version?: number): void {
  const address = new URL(location.href);
  for (const [name, value] of Object.entries({ study, version })) {
    if (value == null) address.searchParams.delete(name);
    else address.searchParams.set(name, String(value));
  }
  history.replaceState(null, '', address);
}

/** The form for the token, or a message on a host without a server. */
export function SignIn() {
  if (!withoutServer.value) return <TokenForm />;
  return (
    <div class="bar">
      <p role="status">{noStudiesHere}</p>
      <Button label="Ask again" onClick={() => noteServer(presence.refresh())} />
    </div>
  );
}

function TokenForm() {
  const input = useRef<HTMLInputElement>(null);
  const problem = useSignal<string | null>(null);
  const pending = useSignal(false);
  async function open(): Promise<void> {
    const token = input.current?.value.trim();
    if (!token) return;
    pending.value = true;
    problem.value = await signIn(token);
    pending.value = false;
  }
  return (
    <div class="bar sign-in">
      <Labelled label="The experimenter’s token">
        <input
          ref={input}
          type="password"
          name="token"
          autocomplete="off"
          aria-label="Token"
          size={40}
          onKeyDown={({ key }) => key === 'Enter' && open()}
        />
      </Labelled>
      <Button label="Open" class="primary" disabled={pending} onClick={open} />
      <p class="soft">The server generates it at its first start and prints the path of its file.</p>
      <Complaint text={problem.value} />
    </div>
  );
}

/** The list of the server's studies; `none` is its text without any. `choose` receives an id or an empty text. */
export function StudyChooser({ none, ...choice }: { readonly none: string } & Pick<ChooserProps, 'chosen' | 'choose'>) {
  const studies = listed.value.map(({ id, title, simulated }) => {
    const marked = simulated && !title.startsWith('SIMULATED') ? `SIMULATED: ${title}` : title;
    return { id, label: `${marked} (${id})` };
  });
  const first = { id: '', label: studies.length === 0 ? none : 'Choose a study' };
  return <Chooser name="Study" choices={[first, ...studies]} {...choice} />;
}

function signOut(): void {
  sessionStorage.removeItem(tokenKey);
  location.reload();
}

export const SignOutButton = () => <Button label="Sign out" onClick={signOut} />;
