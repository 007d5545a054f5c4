const blockPixels = 4;
const blockBytes = 16;
const afterHeader = 80;
const levelBytes = 24;

/** What speaks against unpacking a KTX2 file, before anything of it is: glTF takes flat Basis pictures alone. null: nothing. */
export function ktx2Fault(bytes: Uint8Array): string | null {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < afterHeader) return 'is cut short';
  const field = (at: number) => view.getUint32(at, true);
  const [format, width, height, depth, layers] = [field(12), field(20), field(24), field(28), field(32)];
  const [faces, levels, scheme] = [field(36), field(40), field(44)];
  if (format !== 0 || scheme > 2) return 'is no Basis picture';
  if (width === 0 || height === 0 || depth !== 0 || layers > 1 || faces !== 1) return 'is no flat picture';
  if (levels === 0 || levels > 1 + Math.log2(Math.max(width, height))) return `has ${levels} levels`;
  if (bytes.length < afterHeader + levels * levelBytes) return 'is cut short';
  for (let level = 0; level < levels; level++) {
    const at = afterHeader + level * levelBytes;
    const [from, length, unpacked] = [0, 8, 16].map((part) => Number(view.getBigUint64(at + part, true))) as [
      number,
      number,
      number,
    ];
    if (from + length > bytes.length) return 'is cut short';
    const blocksOf = (size: number) => Math.ceil(Math.max(1, size >> level) / blockPixels);
    if (unpacked > blocksOf(width) * blocksOf(height) * blockBytes) return 'unpacks to more than its size';
  }
  return null;
}
