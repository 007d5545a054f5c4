/**
 * The address of the folder that the page lies in, without a slash at its end: `https://example.org/threepoint`, or an
 * origin alone. The page's own files and its server's routes are found below it; vite.config.ts says how the build
 * learns of it.
 */
export const pageFolder = (): string => new URL(import.meta.env.BASE_URL, location.href).href.replace(/\/$/, '');
