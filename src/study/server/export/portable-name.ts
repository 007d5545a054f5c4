import { createHash } from 'node:crypto';

/** The longest name [characters], below the 255 that file systems accept, so that a prefix and an ending fit. */
const longest = 160;
/** Names that Windows reserves for devices, with or without an ending. */
const reserved = /^(con|prn|aux|nul|com\d|lpt\d)(\.|$)/;

const escaped = (unit: string): string => {
  const code = unit.charCodeAt(0);
  return code > 0xff ? `%u${code.toString(16).padStart(4, '0')}` : `%${code.toString(16).padStart(2, '0')}`;
};

/**
 * Returns a name for a file or folder that differs for every text on every file system: small letters, digits, "-", "@"
 * and "." stay, "/" becomes "_", and all else is escaped as "%" with its code. The ends have no dots, and the names of
 * devices are escaped. Long names end with a hash.
 */
export function portableName(text: string): string {
  const name = text
    .replace(/[^a-z0-9@./-]|^\.|\.$/g, escaped)
    .replaceAll('/', '_')
    .replace(reserved, (device) => `${escaped(device)}${device.slice(1)}`);
  if (name.length <= longest) return name;
  return `${name.slice(0, longest - 65)}~${createHash('sha256').update(text).digest('hex')}`;
}
