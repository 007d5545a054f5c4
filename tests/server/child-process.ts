import type { ChildProcess } from 'node:child_process';

/** The next message of a process; an error where it ends instead. */
export const messageFrom = <T>(child: ChildProcess): Promise<T> =>
  new Promise((resolve, reject) => {
    const ended = (code: number | null): void => reject(new Error(`the server's process ended with ${code}`));
    child.once('exit', ended);
    child.once('message', (message) => {
      child.off('exit', ended);
      resolve(message as T);
    });
  });

export const isAlive = ({ exitCode, signalCode }: ChildProcess): boolean => exitCode === null && signalCode === null;

/** Ends a process at once; resolves when it has ended. */
export const kill = (child: ChildProcess): Promise<void> =>
  new Promise((resolve) => {
    if (!isAlive(child)) resolve();
    else {
      child.once('exit', () => resolve());
      child.kill('SIGKILL');
    }
  });
