// The participant's part of a study on a page, and what a page's tasks implement.
export type { TrialAbsence } from '../model/records/trial-log';
export { createStudyRun, type StudyRun } from './study-run';
export type { Awaited, TaskEnd, TaskEvent, TaskPlace, TaskRunner } from './trial/task-runner';
