import { parseAvatar } from 'threepoint/files';
import { describe, expect, test } from 'vitest';
import { decoders } from '../../../src/page/scene/decoders';
import { builtRig } from '../../threepoint/avatar/built-rig';
import { packedSkin } from '../../threepoint/avatar/packed-skin';
import { vroid } from '../../threepoint/avatar/rig-namings';
import { expectBody, wear } from '../../threepoint/avatar/worn-body';

describe('a rig whose skin is packed by meshopt', () => {
  test('is worn where the page has the means to unpack it, and refused elsewhere', async () => {
    const file = await packedSkin(builtRig({ nameOf: vroid }));
    await expect(parseAvatar(file, 'packed.glb')).rejects.toThrow(
      'packed.glb: is compressed (EXT_meshopt_compression)',
    );
    expectBody(wear(await parseAvatar(file, 'packed.glb', { decoders })));
  });

  test('is refused where it would unpack to more than an avatar may have', async () => {
    const bomb = await packedSkin(builtRig({ nameOf: vroid }), 5e8);
    await expect(parseAvatar(bomb, 'bomb.glb', { decoders })).rejects.toThrow(
      /^bomb\.glb: 6000 million unpacked bytes/,
    );
  });
});
