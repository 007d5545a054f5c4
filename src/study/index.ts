// "threepoint-study": what other packages know of a study.
export { PhrasedError } from './model/phrases/phrases';
export type { Embodiment } from './model/plan/embodiment';
export type { SignedSeat } from './model/progress/study-api';
