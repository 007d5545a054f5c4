// The participant's part of a study on a page, and what a page's tasks implement.
export { createStudyRun, type StudyRun } from './study-run';
export type { TaskEnd, TaskEvent, TaskPlace, TaskRunner } from './trial/task-runner';
