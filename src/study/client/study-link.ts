/** The address of a study page by the parts of its query and its fragment. */
export interface StudyAddress {
  readonly study: string;
  /** null: the page asks for it. */
  readonly participant: string | null;
  readonly invitation: string | null;
}

const name = 'invitation';

/**
 * Returns the link to a place in a study, relative to the folder of the page. The invitation is in the fragment, which
 * browsers do not send and proxies do not log.
 */
export function studyLink({ study, participant, invitation }: StudyAddress): string {
  const query = new URLSearchParams({ study, ...(participant !== null && { participant }) });
  return `./?${query}${invitation === null ? '' : `#${new URLSearchParams({ [name]: invitation })}`}`;
}

/** The page where a participant withdraws from a study, relative to the folder of the page. */
export const withdrawalLink = (study: string): string => `./withdraw?${new URLSearchParams({ study })}`;

/** Returns the invitation in the fragment of an address, or null. */
export const invitationIn = (hash: string): string | null =>
  new URLSearchParams(hash.replace(/^#/, '')).get(name) || null;
