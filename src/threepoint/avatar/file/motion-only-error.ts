/** The error of a file that contains motion and no body. It can be opened as motion capture. */
export class MotionOnlyError extends Error {
  constructor(name: string) {
    super(`${name}: holds motion and no body; open it as motion capture`);
  }
}
