/** SQL that takes from a database of studies what came with its fifth version: the authors of records. */
const withoutAuthors = `
  ALTER TABLE records DROP COLUMN author;
  PRAGMA user_version = 4;`;

/** The schema without authors, and without the plan versions of the fourth version. */
export const withoutPlanVersions = `${withoutAuthors}
  ALTER TABLE studies ADD COLUMN plan TEXT NOT NULL DEFAULT '';
  UPDATE studies SET plan = (SELECT plan FROM plan_versions WHERE study = id);
  ALTER TABLE participants DROP COLUMN plan_version;
  DROP TABLE plan_versions;
  PRAGMA user_version = 3;`;

/** The schema without plan versions, and without the invitations of the second version. */
export const withoutInvitations = `${withoutPlanVersions}
  DROP TABLE software;
  ALTER TABLE participants DROP COLUMN invitation;
  PRAGMA user_version = 1;`;
