/** A page's address with its query and what stands behind "#". */
export interface StudyAddress {
  readonly study: string;
  /** null: the page asks. */
  readonly participant: string | null;
  readonly invitation: string | null;
}

const name = 'invitation';

/** The link to a place in a study, relative to the folder of the page. The invitation stands behind "#", which browsers send to no server and proxies never log. */
export function studyLink({ study, participant, invitation }: StudyAddress): string {
  const query = new URLSearchParams({ study, ...(participant !== null && { participant }) });
  return `./?${query}${invitation === null ? '' : `#${new URLSearchParams({ [name]: invitation })}`}`;
}

/** The page where a participant withdraws from a study, relative to the folder of the page. */
export const withdrawalLink = (study: string): string => `./withdraw?${new URLSearchParams({ study })}`;

/** The invitation behind "#" of an address; null: it holds none. */
export const invitationIn = (hash: string): string | null =>
  new URLSearchParams(hash.replace(/^#/, '')).get(name) || null;
