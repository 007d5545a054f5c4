/** The error of a file of motion alone, which can be opened as motion capture. */
export class MotionWithoutBody extends Error {
  constructor(name: string) {
    super(`${name}: holds motion and no body; open it as motion capture`);
  }
}
