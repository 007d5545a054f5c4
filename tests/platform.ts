/** Whether a file has permission bits. Windows has access lists, which a new file inherits from its folder. */
export const hasFileModes = process.platform !== 'win32';

/** Whether files that a process has open can be renamed and deleted. Windows refuses it. */
export const movesOpenFiles = process.platform !== 'win32';

/** Whether every address of 127.0.0.0/8 is this machine. macOS has 127.0.0.1 alone. */
export const hasLoopbackNetwork = process.platform !== 'darwin';
